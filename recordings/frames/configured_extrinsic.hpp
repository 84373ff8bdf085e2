// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/lie.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// The pose of the sensor in the frame of the IMU that the configuration states, whichever form it
/// has. Errors name `key`, or the file with its line, and what was expected.
Result<Pose> configured_extrinsic(const ExtrinsicConfig& config, std::string_view key);

/// The configuration with the plain form of each extrinsic that it states.
Result<RecordingConfig> with_plain_extrinsics(RecordingConfig config);

/// Error for an extrinsic in numbers that are no pose, at the place of its key among those that
/// were set.
Result<void> check_extrinsics(const RecordingConfig& config, std::span<const AssignedKey> assigned);

/// Takes relative names of calibrations as relative to the folder of the configuration that names
/// them; one that is there only from the working directory stays.
void find_calibrations(RecordingConfig& config, const std::filesystem::path& folder);

}  // namespace aims
