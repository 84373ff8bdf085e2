// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Whether the first line with numbers or a header has cells that commas or semicolons separate.
bool is_pose_table(std::string_view text);

/// The lines of such a table as those of the TUM format, line by line: the stamp in nanoseconds or
/// seconds, the position, and the quaternion with w first (EuRoC) or last, by the header or,
/// without one, first where stamps are in nanoseconds. Further columns are left out. A table of
/// fewer than eight columns has positions alone: lines "stamp x y z", with a note where it has more
/// columns than these. Errors: "name:line: ...".
Result<std::string> tum_of_pose_table(std::string_view text, const std::string& name,
                                      std::vector<std::string>& notes);

}  // namespace aims
