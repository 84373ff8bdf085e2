// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Validation of poses in a file.
enum class PoseRules {
  kStrict,   ///< an invalid pose, or a stamp that does not increase, is an error
  kAsGiven,  ///< invalid and unordered poses are kept, for scoring to count
};

/// Lines "stamp x y z qx qy qz qw" of the TUM format: seconds with nine decimals, which keep the
/// nanoseconds exactly, and shortest decimals that read back to the same doubles.
std::string tum_text(std::span<const StampedPose> poses);

/// Reads TUM text ('#' starts a comment line). Stamps must increase strictly, numbers be finite
/// and quaternions of unit norm within 1e-3 (then normalized), except under kAsGiven.
/// Errors: "name:line: ...".
Result<Trajectory> parse_tum(std::string_view text, const std::string& name,
                             PoseRules rules = PoseRules::kStrict);

/// Writes `tum_text` atomically.
Result<void> write_tum(const std::filesystem::path& file, const Trajectory& trajectory);

/// Reads a TUM file with `parse_tum`, by pages: of the text next to nothing stays in memory.
Result<Trajectory> read_tum(const std::filesystem::path& file,
                            PoseRules rules = PoseRules::kStrict);

}  // namespace aims
