// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

namespace aims {

/// Number of occurrences of each event, by name: "cloud_points_not_finite".
using EventCounts = std::map<std::string, int>;

}  // namespace aims
