// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace aims {

/// Numbers of trajectories in text that are not finite: NaN, infinity, or empty cells, which are
/// NaN. The lines are those of TUM, of positions or of KITTI poses.

/// The lines with blank ones in place of those without a finite stamp, at which no pose can be;
/// notes how many, and the first.
std::string with_stamps(std::string_view text, const std::string& name,
                        std::vector<std::string>& notes);

/// Notes the first number that is not finite behind the stamps, and how many lines hold one.
void note_missing_numbers(std::string_view text, const std::string& name,
                          std::vector<std::string>& notes);

}  // namespace aims
