// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "core/leg_geometry.hpp"
#include "core/measurements.hpp"

namespace aims {

/// Legs of the default robot, `models/quadruped`; a test compares them with its files.
inline constexpr LegGeometry kRobotGeometry{.hip_x = 0.188,
                                            .hip_y = 0.047,
                                            .abduction = 0.08,
                                            .thigh = 0.213,
                                            .calf = 0.213,
                                            .foot_radius = 0.022};

using LegGeometries = std::array<LegGeometry, kLegCount>;

/// Four legs as the drawings of the default robot have them.
inline constexpr LegGeometries kNominalLegs = {kRobotGeometry, kRobotGeometry, kRobotGeometry,
                                               kRobotGeometry};

/// How the legs of a built robot differ from the drawings.
struct BuildErrors {
  /// Standard deviation of the relative error of thighs and calves. Half of its variance is common
  /// to the four legs, as a wrong drawing is, half is each leg's own, as wear is [-].
  double link_length = 0.0;
  double foot_radius = 0.0;  ///< true radius of every foot less the drawn one [m]
};

/// Legs of one built robot. Random stream: "leg.lengths".
LegGeometries built_legs(const LegGeometry& drawn, const BuildErrors& errors,
                         std::uint64_t run_seed);

}  // namespace aims
