// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <vector>

#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"

namespace aims {

/// How a foot in contact states that the base rises.
struct FootRise {
  int leg = 0;
  double speed = 0.0;  ///< of the base along its z, by this foot [m/s]
};

/// How feet in contact state that the base rises where joints have no rates: by central differences
/// of the places of the feet. Differences to the last angles are those of half a step ago, and
/// they show more than filtered rates how a foot that still counts as standing lifts off.
class FootDifferences {
 public:
  explicit FootDifferences(const LegGeometry& geometry) : geometry_(geometry) {}

  /// The legs at an instant, after those before. Returns the feet that stand well before and after
  /// an earlier instant.
  std::vector<FootRise> add(const LegOdometrySample& legs);

 private:
  struct Instant {
    Time stamp = 0;
    Eigen::Vector3d turning;                      ///< of the base [rad/s]
    std::array<Eigen::Vector3d, kLegCount> feet;  ///< in the base [m]
    std::array<bool, kLegCount> contact{};
  };
  LegGeometry geometry_;
  std::deque<Instant> last_;
};

}  // namespace aims
