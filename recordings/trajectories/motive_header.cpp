// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/motive_header.hpp"

#include <algorithm>
#include <cstddef>

namespace aims {

bool MotiveHeader::take(const std::vector<std::string_view>& cells) {
  const auto has = [&](std::string_view word) { return std::ranges::count(cells, word) > 0; };
  const bool groups = has("Rotation") && has("Position");
  begun_ = begun_ || groups || (!cells.empty() && cells[0] == "Format Version");
  if (!begun_ || !names_.empty()) return false;
  if (has("Millimeters")) unit_ = "mm";
  if (has("Centimeters")) unit_ = "cm";
  if (groups) groups_.assign(cells.begin(), cells.end());
  if (groups_.empty() || cells.empty() || cells[0] != "Frame") return true;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::string name(cells[i]);
    const bool grouped = i < groups_.size() && !groups_[i].empty();
    if (grouped) name = groups_[i] + '.' + name;
    if (grouped && groups_[i] == "Position") name += " [" + unit_ + ']';
    names_.push_back(std::move(name));
  }
  return true;
}

}  // namespace aims
