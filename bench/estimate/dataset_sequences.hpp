// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/estimate/dataset_profile.hpp"
#include "bench/estimate/estimate.hpp"
#include "core/error.hpp"

namespace aims {

/// A sequence of a data set.
struct DatasetSequence {
  std::string name;
  std::filesystem::path recording;  ///< a file, a folder of rosbag2, or of several recordings
  std::string truth;                ///< as --truth of aims score; empty: none was found
  std::string lever_arms = {};      ///< file of the measured points in the body; empty: none
  std::string lack = {};            ///< why it cannot be scored; empty: it can
  /// The folder of its files: of the recording, or above it where that holds recordings alone.
  std::filesystem::path home = {};
};

/// The sequences of a folder, by name: each recording, and each folder below that holds some,
/// itself or in a folder of its own (`rosbag`), with their truths. Error for a folder without any.
Result<std::vector<DatasetSequence>> dataset_sequences(const DatasetProfile& profile,
                                                       const std::filesystem::path& folder);

/// What decides the result of a sequence besides the code: its files with size and time.
std::string fingerprint(const DatasetSequence& sequence);

/// The file of the truth, or its topic.
std::string truth_text(const DatasetProfile& profile, const DatasetSequence& sequence);

/// How the sequence is scored: its truth, and how the estimates are moved to it; a line each.
std::vector<std::string> scoring_notes(const DatasetProfile& profile,
                                       const DatasetSequence& sequence);

/// Estimates one sequence by one estimator and scores it as the profile says; `folder` takes the
/// trajectory. Errors as of `estimate` and `read_scoring_input`.
Result<EstimateResult> estimate_sequence(const DatasetProfile& profile,
                                         const DatasetSequence& sequence,
                                         const std::string& estimator,
                                         const std::filesystem::path& folder,
                                         const Observer& observer);

}  // namespace aims
