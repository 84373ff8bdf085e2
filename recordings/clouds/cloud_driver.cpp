// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/clouds/cloud_driver.hpp"

#include <algorithm>
#include <initializer_list>

#include "recordings/messages/point_layout.hpp"

namespace aims {

std::string_view driver_of(const PointTable& table) {
  if (table.find("offset_time") != nullptr && table.find("line") != nullptr) {
    return "livox_ros_driver, CustomMsg";
  }
  for (const CloudLayout layout :
       {CloudLayout::kOuster, CloudLayout::kLivox, CloudLayout::kHesai, CloudLayout::kVelodyne}) {
    const PointLayout known = point_layout(layout);
    const bool all = std::ranges::all_of(known.fields, [&](const PointFieldLayout& field) {
      return table.find(field.name) != nullptr;
    });
    if (all) return known.driver;
  }
  return {};
}

}  // namespace aims
