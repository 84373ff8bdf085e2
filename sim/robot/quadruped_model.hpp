// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace aims {

/// The robot as an MJCF document of its own (models/quadruped/quadruped.xml), built into the library.
/// Bodies: `trunk`, and per leg `FL_hip`, `FL_thigh`, `FL_calf`; sites: `imu`, `lidar`, `FL_foot`.
std::string_view quadruped_mjcf();

}  // namespace aims
