// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "recordings/source/recording_file.hpp"

namespace aims::test {

/// A file and the topics it takes.
struct SplitPart {
  std::filesystem::path file;
  RecordingFormat format;
  std::vector<std::string> topics;  ///< empty: all that no other part has
};

/// Copies the messages of `whole` to the parts, by topic. Failures are those of the test.
void split_recording(const std::filesystem::path& whole, std::vector<SplitPart> parts);

}  // namespace aims::test
