// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Reads the waypoint times of a run: a header "point,stamp_s", then one row each; the stamps [s]
/// must not decrease. Names may be quoted as in RFC 4180. Errors: "name:line:
/// ...".
Result<std::vector<WaypointTime>> parse_waypoint_times(std::string_view text,
                                                       const std::string& name);

/// The same of a file.
Result<std::vector<WaypointTime>> read_waypoint_times(const std::filesystem::path& file);

}  // namespace aims
