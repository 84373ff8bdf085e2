// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/leg_geometry.hpp"

namespace aims {

/// Legs of the default robot, `models/quadruped`; a test compares them with its files.
inline constexpr LegGeometry kRobotGeometry{.hip_x = 0.188,
                                            .hip_y = 0.047,
                                            .abduction = 0.08,
                                            .thigh = 0.213,
                                            .calf = 0.213,
                                            .foot_radius = 0.022};

}  // namespace aims
