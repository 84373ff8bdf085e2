// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "recordings/clouds/point_table.hpp"

namespace aims {

/// The ROS driver that names the fields of its points so ("ouster-ros"); empty: none that is known.
std::string_view driver_of(const PointTable& table);

}  // namespace aims
