// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
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

/// The unit of the stamps of a table.
enum class StampUnit { kByDigits, kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

/// Which columns of a table hold stamp, position and quaternion.
struct PoseColumns {
  std::size_t stamp = 0;
  std::optional<std::size_t> nanoseconds;  ///< of the second that `stamp` counts
  StampUnit unit = StampUnit::kByDigits;
  std::array<std::size_t, 3> position = {1, 2, 3};
  bool is_down = false;       ///< the third of the position points down, and attitudes are not read
  bool y_is_up = false;       ///< the second of position and quaternion is the negative third
  int position_decimals = 0;  ///< by which their unit lies below metres: of cm 2, of mm 3
  std::optional<std::array<std::size_t, 4>> quaternion_xyzw;
  std::optional<std::array<std::size_t, 3>> rpy;  ///< in place of the quaternion
  bool rpy_in_degrees = false;                    ///< else rad
  bool rpy_has_unit = false;                      ///< the header states it
  std::optional<std::size_t> matrix;  ///< first of the 12 of a 3x4 matrix, row by row, for all

  bool has_attitude() const { return quaternion_xyzw || rpy || matrix; }
  /// The number of columns that a row needs.
  std::size_t least() const;
};

/// The columns that a header names, as TUM, EuRoC, the Newer College ("sec,nsec,x,..."),
/// `rostopic echo -p` ("field.pose.pose.position.x") and PlotJuggler ("/odom/pose/position/x")
/// write them; nothing where it names no stamp or no position. The first column of a name counts,
/// one of a position before others, and none of a velocity or acceleration. Without x, y, z: east,
/// north, up or down, in any order.
std::optional<PoseColumns> named_columns(std::span<const std::string_view> header);

/// Whether the header names a latitude or longitude, which are no positions in metres.
bool names_degrees(std::span<const std::string_view> header);

/// Whether the columns behind the first are named as velocities or accelerations.
bool names_motion(std::span<const std::string_view> header);

/// The columns of a world and a body with y up, as of one with z up.
PoseColumns with_y_up(PoseColumns columns);

/// The columns of a table without names: stamp, position, and from 8 columns on the quaternion; of
/// 13 or 17 columns stamp and matrix, as of MulRan.
PoseColumns ordered_columns(std::size_t columns, bool w_first);

}  // namespace aims
