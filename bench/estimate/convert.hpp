// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/estimate/progress.hpp"
#include "core/error.hpp"
#include "recordings/bag/compression.hpp"
#include "recordings/source/conversion.hpp"

namespace aims {

struct ConvertOptions {
  std::filesystem::path from;  ///< recording of any format
  std::filesystem::path to;    ///< .bag, .mcap or folder/ to write; it must not exist
  bool overwrite = false;      ///< unless this is set
  bool recover = false;        ///< read the intact part of a damaged recording
  BagCompression compression = BagCompression::kNone;
  std::vector<std::filesystem::path> with = {};  ///< further files of the same recording
  std::vector<std::string> drop = {};            ///< topics that are left out
};

/// What a conversion has become.
struct ConvertOutcome {
  ConversionOutcome content;
  std::uint64_t lost_bytes = 0;  ///< of a damaged recording
  std::string left_out;          ///< rows of a table without a time, in words; empty: none
  std::uintmax_t bytes = 0;      ///< of the new one
};

/// Writes a recording in another format or compression. The new one appears whole or not at all.
/// Error when it cannot be read, written, or expressed in that format, when it has no topic that is
/// to be left out, and when no topic is left.
Result<ConvertOutcome> convert(const ConvertOptions& options, const Observer& observer);

}  // namespace aims
