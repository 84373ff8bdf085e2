// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/config.hpp"
#include "core/measurements.hpp"

namespace aims {

/// How strongly a standing robot keeps its feet apart.
struct StanceHoldConfig {
  double stiffness = 1000.0;  ///< beyond the tolerance [N/m]
  double max_force = 10.0;    ///< on a foot, root mean square [N]
};
void describe(Fields& f, StanceHoldConfig& c);

/// Keeps the feet of a standing robot apart as they were when it came to stand.
///
/// The forces that carry the trunk do not carry the legs: their weight pulls the feet inwards. On a
/// contact that gives way a little under any tangential force, as that of the simulation, the feet
/// then creep towards each other, by some 0.2 mm/s, until the stance is too narrow to stand on.
class StanceHold {
 public:
  using Feet = std::array<Eigen::Vector3d, kLegCount>;  ///< positions in the world [m]
  using Offsets = Eigen::Matrix<double, 2, kLegCount>;  ///< one column per foot, world axes

  explicit StanceHold(const StanceHoldConfig& config = {}) : config_(config) {}

  /// The feet stand where they are to stay.
  void begin(const Feet& feet);

  /// Horizontal forces of the ground on the feet [N] that return each foot to its place among the
  /// others. They have no sum and no moment: the trunk does not feel them. Zero while the feet are
  /// within a tolerance of their places, as in every short pause.
  Offsets forces(const Feet& feet) const;

 private:
  StanceHoldConfig config_;
  Offsets places_ = Offsets::Zero();  ///< of the feet about their mean [m]
};

}  // namespace aims
