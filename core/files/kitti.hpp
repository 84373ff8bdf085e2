// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/files/tum.hpp"
#include "core/lie.hpp"
#include "core/time.hpp"

namespace aims {

/// Reads KITTI poses: twelve numbers a line, the first three rows of the 4x4 pose, row by row; '#'
/// starts a comment line. The rotation must be orthonormal within 5e-3 (and is then
/// orthonormalized) and all numbers finite, except under kAsGiven. Errors: "name:line: ...".
Result<std::vector<Pose>> parse_kitti(std::string_view text, const std::string& name,
                                      PoseRules rules = PoseRules::kStrict);

/// Reads stamps in seconds, one a line, as KITTI's times.txt. They must increase strictly. Errors:
/// "name:line: ...".
Result<std::vector<Time>> parse_times(std::string_view text, const std::string& name);

}  // namespace aims
