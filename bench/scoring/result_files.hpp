// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/scoring/outcome.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/csv.hpp"

namespace aims {

/// Writes scores.json and scores.csv.
Result<void> write_record(const RunRecord& record, const std::filesystem::path& folder);

/// Reads a scores.json; error when it is not one, e.g. cut short.
Result<RunRecord> read_record(const std::filesystem::path& file);

/// Name of the folder of one run among those of several seeds: "seed-3".
std::string seed_folder_name(std::uint64_t seed);

/// The folders of that kind in `parent`, by seed.
std::vector<std::filesystem::path> seed_folders_in(const std::filesystem::path& parent);

/// Ending of the file of a re-optimized trajectory.
inline constexpr const char* kOptimizedEnding = ".optimized.tum";

/// Writes the rows of one estimator in parts: NAME.tum, NAME.diagnostics.csv and
/// NAME.health.csv, which appear on commit() and until then grow beside themselves as .tmp files.
class RowWriter {
 public:
  static Result<RowWriter> create(const std::filesystem::path& folder, const std::string& name);
  /// Writes the rows that follow those before.
  Result<void> add(const EstimatorRows& rows);
  Result<void> commit();

 private:
  RowWriter(AtomicFile poses, AtomicFile scans, AtomicFile health);

  AtomicFile poses_;
  AtomicFile scans_;
  AtomicFile health_;
  std::optional<CsvTable> scan_table_;  ///< from the first rows on
  CsvTable health_table_;
};

/// Writes what one estimator came to: NAME.tum, where it has them the re-optimized trajectory
/// (NAME.optimized.tum) and its map (NAME.map.ply), NAME.diagnostics.csv and NAME.health.csv.
Result<void> write_estimator(const EstimatorOutcome& outcome, const std::filesystem::path& folder,
                             const std::string& name);

/// Rewrites NAME.health.csv with reasons that were found at the end: in all rows but those before
/// the start, which are then degraded at best. Nothing where there is no such file.
Result<void> add_health_reasons(const std::filesystem::path& folder, const std::string& name,
                                const std::vector<std::string>& reasons);

/// Writes of these what is no row: the re-optimized trajectory and the map.
Result<void> write_map_and_optimized(const EstimatorOutcome& outcome,
                                     const std::filesystem::path& folder, const std::string& name);

/// Of those files, what is read besides the trajectories.
struct EstimatorParts {
  bool diagnostics = true;
  bool map = true;
};

/// Reads those files but for the health; the outcome has no scores.
Result<EstimatorOutcome> read_estimator(const std::filesystem::path& folder,
                                        const std::string& name, const EstimatorParts& parts = {});

/// Endings of those files, with their dots.
inline constexpr const char* kEstimatorFiles[] = {".tum", kOptimizedEnding, ".map.ply",
                                                  ".diagnostics.csv", ".health.csv"};

}  // namespace aims
