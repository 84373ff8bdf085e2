// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "recordings/source/recording_file.hpp"

namespace aims {

/// The format that the name of a new recording stands for; error for any other name.
Result<RecordingFormat> format_of_new(const std::filesystem::path& file);

/// The name under which recording begins, NAME.partial; what is there may be replaced only where
/// `overwrite` is set. An existing recording stays until the new one is whole.
Result<std::filesystem::path> begin_recording(const std::filesystem::path& file, bool overwrite);

/// Gives the finished recording its name.
Result<void> publish_recording(const std::filesystem::path& partial,
                               const std::filesystem::path& file);

}  // namespace aims
