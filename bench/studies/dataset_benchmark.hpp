// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bench/estimate/dataset_sequences.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// The sequences of a data set through the estimators, scored as its authors score them.
struct DatasetBenchmark {
  DatasetProfile profile;
  std::vector<DatasetSequence> sequences;
  Suite suite;  ///< a case per sequence, with one run of seed 0
  /// What the columns are, where the published ones are from, and what was assumed of each
  /// sequence.
  std::vector<std::string> notes;
};

/// Does what `options.out` lacks, each estimator on each sequence in a process of its own.
Result<DatasetBenchmark> run_dataset_benchmark(DatasetProfile profile,
                                               std::vector<DatasetSequence> sequences,
                                               JobOptions options, const JobObserver& observer);

/// A row per sequence: the score of each estimator here, then the published ones.
TextTable benchmark_table(const DatasetBenchmark& benchmark);

/// The score of the profile, its unit, and how its authors compute it.
std::string benchmark_score_text(const DatasetProfile& profile);

/// Version of the layout of benchmark.json; see docs/result-files.md.
inline constexpr std::string_view kBenchmarkSchema = "aims.benchmark/1";

/// What benchmark.json holds.
Json benchmark_json(const DatasetBenchmark& benchmark);

/// Writes benchmark.md and benchmark.json, and the files of a suite.
Result<void> write_benchmark(const DatasetBenchmark& benchmark,
                             const std::filesystem::path& folder);

}  // namespace aims
