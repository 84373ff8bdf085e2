// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Whether the text is anything but lines of 4, 8 or 12 numbers with blanks or tabs between them
/// and stamps in seconds: a table with a header or other separators, stamps as integers of ms, µs
/// or ns, comments of '%' or '//', or behind a row, or lines that end in a carriage return alone.
bool is_pose_table(std::string_view text);

/// The stamp in seconds: its decimal point moved to the left by `decimals`; one with an exponent is
/// divided, and what is no number stays.
std::string stamp_in_seconds(std::string_view stamp, int decimals);

/// The lines of such a table as those of the TUM format, line by line. Cells are separated by
/// semicolons, commas, tabs or blanks, with decimal commas where these do not separate. Columns are
/// those that the header names; without names stamp, position and quaternion, of which w comes
/// first where stamps are integers of ns (EuRoC). Stamps are in the unit of the header, else by
/// their digits: of 17 and more ns, of 16 µs, of 13 ms, which is noted; what neither tells lies
/// `decimals` below seconds. Empty cells are NaN.
/// Without a quaternion: lines "stamp x y z", with a note where there are further columns. Errors:
/// "name:line: ...".
Result<std::string> tum_of_pose_table(std::string_view text, const std::string& name, int decimals,
                                      std::vector<std::string>& notes);

}  // namespace aims
