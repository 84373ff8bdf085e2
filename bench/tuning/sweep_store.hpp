// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/jobs/job_store.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// Version of the layout of sweep.sqlite; see docs/studies-and-tuning.md.
inline constexpr std::string_view kSweepSchema = "aims.sweep/1";

/// A job that a sweep was to do and its file, null when there is none.
struct MergedJob {
  ListedJob listed;
  Json file;

  /// "done", "invalid", "failed", "crashed", "timed_out" or "missing".
  std::string outcome() const;
  bool is_missing() const { return file.is_null(); }
  bool is_done() const;
  /// Why its run is invalid (bench/scoring/validity.hpp).
  std::optional<std::string> invalid() const;
};

/// Every job of one or several folders.
struct MergedSweep {
  std::vector<MergedJob> jobs;  ///< in the order of the plans; each id once
  std::vector<std::string> plans;
  std::size_t repeated = 0;  ///< jobs that failed in one folder and are done in another: done
  std::size_t others = 0;    ///< results in the folders that are of no listed job, left out

  std::size_t count(std::string_view outcome) const;
};

/// Reads the folders' jobs; of a job that several have, the one that is done. Works while sweeps
/// fill them: what is not there yet is missing. Error when one is not the folder of a sweep, and
/// for different plans, unless they differ in seeds, scenarios, tags or estimators alone.
Result<MergedSweep> merge_sweeps(std::span<const std::filesystem::path> folders);

/// Writes the jobs as an SQLite database with the tables jobs, parameters, scores and about. The
/// file appears whole.
Result<void> write_sqlite(const MergedSweep& sweep, const std::filesystem::path& file);

/// Writes the jobs as one table: a row per job, a column per parameter and score.
Result<void> write_sweep_csv(const MergedSweep& sweep, const std::filesystem::path& file);

/// Jobs by scenario and outcome.
TextTable merge_table(const MergedSweep& sweep);

}  // namespace aims
