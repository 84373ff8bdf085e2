// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Reads the waypoint times that a run writes: a header line "point,stamp_s", then a row each; the
/// stamps in seconds must not decrease. Names may be quoted as in RFC 4180. Errors: "name:line:
/// ...".
Result<std::vector<WaypointTime>> parse_waypoint_times(std::string_view text,
                                                       const std::string& name);

}  // namespace aims
