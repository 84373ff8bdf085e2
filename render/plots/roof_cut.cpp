// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/roof_cut.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace aims {

std::vector<bool> under_roof(std::span<const Eigen::Vector3f> points, double section) {
  constexpr float kCell = 2.0F;
  const auto cell_of = [](const Eigen::Vector3f& p) {
    const auto column = static_cast<std::int64_t>(std::floor(p.x() / kCell));
    const auto row = static_cast<std::int64_t>(std::floor(p.y() / kCell));
    return (column << 32) + row;
  };
  std::unordered_map<std::int64_t, float> floor;  // looked up only, never iterated
  for (const Eigen::Vector3f& point : points) {
    const auto [entry, fresh] = floor.try_emplace(cell_of(point), point.z());
    if (!fresh) entry->second = std::min(entry->second, point.z());
  }
  std::vector<bool> under;
  under.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    under.push_back(point.z() <= floor.at(cell_of(point)) + static_cast<float>(section));
  }
  return under;
}

}  // namespace aims
