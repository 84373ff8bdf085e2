// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "core/leg_geometry.hpp"
#include "core/measurements.hpp"
#include "sim/robot/robot_geometry.hpp"

namespace aims {

using LegGeometries = std::array<LegGeometry, kLegCount>;

/// Four legs as the drawings of the default robot have them.
inline constexpr LegGeometries kNominalLegs = {kRobotGeometry, kRobotGeometry, kRobotGeometry,
                                               kRobotGeometry};

/// Legs of one built robot: thighs and calves differ from the drawings by a relative error of
/// standard deviation `error`. Half of its variance is common to the four legs, as a wrong drawing
/// is, half is each leg's own, as wear is. Random stream: "leg.lengths".
LegGeometries built_legs(const LegGeometry& drawn, double error, std::uint64_t run_seed);

}  // namespace aims
