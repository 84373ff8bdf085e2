// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"

namespace aims {

/// Legs by slot, or by entry of the contacts. A slot is one abduction, hip and knee each.
using Legs = std::array<int, kLegCount>;

/// What one row says.
struct LegEvidence {
  /// Velocity of the base by each slot taken as each leg, if its foot stands [m/s].
  std::array<std::array<Eigen::Vector3d, kLegCount>, kLegCount> velocity;
  std::array<std::array<double, kLegCount>, kLegCount> height;  ///< of the foot in the base [m]
  std::array<bool, kLegCount> contact{};                        ///< by entry
};

/// One assignment.
struct LegCandidate {
  Legs leg_of_slot{};
  Legs leg_of_entry{};
  double disagreement = 0.0;  ///< mean square difference of the velocities by feet in contact
};

/// Every order of the legs by slot and by entry, or the one that is known; those that robots use
/// come first. `pairs_first`: with the left legs before the right ones. An order whose feet are
/// higher in contact than in swing is made to disagree.
std::vector<LegCandidate> leg_candidates(const std::vector<LegEvidence>& rows, bool joints_known,
                                         bool feet_known, bool pairs_first);

/// Mean velocity by the feet in contact, row by row [m/s].
std::vector<Eigen::Vector3d> velocities(const std::vector<LegEvidence>& rows,
                                        const LegCandidate& candidate);

/// Whether they differ by less than a twentieth.
bool same_velocity(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b);

}  // namespace aims
