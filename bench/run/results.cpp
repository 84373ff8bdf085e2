// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/results.hpp"

#include "bench/run/health_summary.hpp"
#include "bench/run/tables.hpp"
#include "core/files/ply.hpp"
#include "core/files/tum.hpp"

namespace aims {

namespace fs = std::filesystem;

Result<void> write_estimator(const EstimatorOutcome& outcome, const fs::path& folder,
                             const std::string& name) {
  auto written = write_tum(folder / (name + ".tum"), outcome.result.trajectory);
  if (written && outcome.result.optimized) {
    written = write_tum(folder / (name + kOptimizedEnding), *outcome.result.optimized);
  }
  if (written && !outcome.map.empty()) {
    written = write_ply(folder / (name + ".map.ply"), outcome.map);
  }
  if (written) {
    written = write_csv(folder / (name + ".diagnostics.csv"), diagnostics_table(outcome));
  }
  if (!written) return written;
  return write_csv(folder / (name + ".health.csv"), health_table(outcome.result.health));
}

Result<EstimatorOutcome> read_estimator(const fs::path& folder, const std::string& name) {
  EstimatorOutcome outcome;
  outcome.name = name;
  auto trajectory = read_tum(folder / (name + ".tum"), PoseRules::kAsGiven);
  if (!trajectory) return tl::unexpected(trajectory.error());
  outcome.result.trajectory = std::move(*trajectory);
  if (const fs::path file = folder / (name + kOptimizedEnding); fs::exists(file)) {
    auto optimized = read_tum(file, PoseRules::kAsGiven);
    if (!optimized) return tl::unexpected(optimized.error());
    outcome.result.optimized = std::move(*optimized);
  }
  auto diagnostics = read_diagnostics(folder / (name + ".diagnostics.csv"));
  if (!diagnostics) return tl::unexpected(diagnostics.error());
  outcome.result.diagnostics = std::move(*diagnostics);
  const fs::path map = folder / (name + ".map.ply");
  if (!fs::exists(map)) return outcome;
  auto points = read_ply(map);
  if (!points) return tl::unexpected(points.error());
  outcome.map = std::move(*points);
  return outcome;
}

}  // namespace aims
