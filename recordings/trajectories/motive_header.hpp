// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace aims {

/// The header of an export of Motive (OptiTrack): rows that state units, names and, for each
/// column, "Rotation" or "Position", and at last one of "Frame", "Time (Seconds)", "X", "Y", ...
class MotiveHeader {
 public:
  /// Whether the cells are a row of such a header.
  bool take(const std::vector<std::string_view>& cells);
  /// The names of the columns, as "Position.X [m]"; empty before the last row.
  const std::vector<std::string>& names() const { return names_; }

 private:
  bool begun_ = false;
  std::string unit_ = "m";           ///< of positions
  std::vector<std::string> groups_;  ///< "Rotation" or "Position"
  std::vector<std::string> names_;
};

}  // namespace aims
