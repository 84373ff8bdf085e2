// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/results.hpp"

#include <fmt/format.h>

#include "bench/run/tables.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/ply.hpp"
#include "core/files/tum.hpp"

namespace aims {

namespace fs = std::filesystem;

Result<void> write_estimator(const EstimatorOutcome& outcome, const fs::path& folder) {
  auto written = write_tum(folder / (outcome.name + ".tum"), outcome.result.trajectory);
  if (!written) return written;
  if (!outcome.map.empty()) {
    written = write_ply(folder / (outcome.name + ".map.ply"), outcome.map);
    if (!written) return written;
  }
  return write_csv(folder / (outcome.name + ".diagnostics.csv"), diagnostics_table(outcome));
}

Result<void> write_streams(const Scenario& scenario, const RunResult& result,
                           const fs::path& folder) {
  auto written =
      write_file_atomically(folder / "config.yaml", effective_config(scenario, result.seed));
  if (written)
    written = write_tum(folder / "truth.tum", thinned(result.truth_trajectory, kTruthSpacing));
  if (written)
    written =
        write_csv(folder / "waypoint_times.csv", waypoint_times_table(result.truth.waypoint_times));
  if (written)
    written = write_csv(folder / "localizability.csv", localizability_table(result.localizability));
  if (written) written = write_csv(folder / "legs.csv", legs_table(result.legs));
  for (const EstimatorOutcome& outcome : result.estimators) {
    if (written) written = write_estimator(outcome, folder);
  }
  return written;
}

Result<void> write_results(const Scenario& scenario, const RunResult& result,
                           const RunRecord& record, const fs::path& folder) {
  auto written = write_streams(scenario, result, folder);
  if (written) written = write_csv(folder / "scores.csv", scores_csv({&record, 1}));
  if (written)
    written = write_file_atomically(folder / "scores.json", record.scores.dump(2) + "\n");
  return written;
}

}  // namespace aims
