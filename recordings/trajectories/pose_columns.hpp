// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace aims {

/// The unit of the stamps of a table.
enum class StampUnit { kByDigits, kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// Which columns of a table hold stamp, position and quaternion.
struct PoseColumns {
  std::size_t stamp = 0;
  std::optional<std::size_t> nanoseconds;  ///< of the second that `stamp` counts
  StampUnit unit = StampUnit::kByDigits;
  std::array<std::size_t, 3> position = {1, 2, 3};
  std::optional<std::array<std::size_t, 4>> quaternion_xyzw;

  /// The number of columns that a row needs.
  std::size_t least() const;
};

/// The columns that a header names, as TUM, EuRoC, the Newer College ("sec,nsec,x,..."), and
/// `rostopic echo -p` ("field.pose.pose.position.x") write them; nothing where it names no stamp or
/// no position. The first column of a name counts.
std::optional<PoseColumns> named_columns(std::span<const std::string_view> header);

/// The columns of a table without names: stamp, position, and from 8 columns on the quaternion.
PoseColumns ordered_columns(std::size_t columns, bool w_first);

}  // namespace aims
