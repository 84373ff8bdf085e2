// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/error.hpp"
#include "recordings/source/recording_file.hpp"

namespace aims {

/// The format that the name of a new recording stands for: .bag, .mcap, or a folder of rosbag2 for
/// a name that ends in "/"; error for any other name.
Result<RecordingFormat> format_of_new(const std::filesystem::path& file);

/// The name of a new recording without the "/" at its end.
std::filesystem::path path_of_new(const std::filesystem::path& file);

/// The name under which recording begins, NAME.partial; what is there may be replaced only where
/// `overwrite` is set: a file, or a folder that holds nothing but a recording of rosbag2. An
/// existing recording stays until the new one is whole.
Result<std::filesystem::path> begin_recording(const std::filesystem::path& file, bool overwrite);

/// Gives the finished recording its name.
Result<void> publish_recording(const std::filesystem::path& partial,
                               const std::filesystem::path& file);

/// Bytes of a recording, of a folder those of its files.
std::uintmax_t recording_size(const std::filesystem::path& recording);

}  // namespace aims
