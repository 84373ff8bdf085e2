// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/jobs/sequence_cache.hpp"
#include "bench/run/run_localizability.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/scoring/tables.hpp"
#include "bench/studies/detectors.hpp"
#include "core/files/csv_columns.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The equivalent returns of each scan in a localizability.csv.
Result<std::vector<Localizability>> read_truth(const fs::path& file) {
  const auto table = CsvColumns::read(file);
  if (!table) return tl::unexpected(table.error());
  const auto stamps = table->numbers("stamp_s");
  const auto returns = table->numbers("equivalent_returns");
  if (!stamps) return tl::unexpected(stamps.error());
  if (!returns) return tl::unexpected(returns.error());
  std::vector<Localizability> scans(std::min(stamps->size(), returns->size()));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i].stamp = from_seconds((*stamps)[i]);
    scans[i].equivalent_returns = (*returns)[i];
  }
  return scans;
}

Result<DetectorRun> read_run(const Job& job, const JobStore& store) {
  const fs::path diagnostics =
      store.outputs_of(job.id) / fmt::format("{}.diagnostics.csv", kEstimateName);
  const auto scans = read_diagnostics(diagnostics);
  if (!scans) return tl::unexpected(scans.error());
  if (scans->scans.empty()) {
    return failure(
        fmt::format("estimator {} records no diagnostics of scans", job.estimator.label));
  }
  const fs::path sequence = store.sequence_of(SequenceCache::id_of(*job.scenario, job.seed));
  const auto truth = read_truth(sequence / "localizability.csv");
  if (!truth) return tl::unexpected(truth.error());
  DetectorRun run = detector_run(*scans, *truth, half_scan(job.scenario->simulation));
  run.scenario = job.scenario->name;
  run.seed = job.seed;
  return run;
}

}  // namespace

Result<DetectorStudy> detector_study(const Suite& suite, const fs::path& folder) {
  const JobStore store(folder);
  DetectorStudy study;
  for (const Job& job : suite.jobs) {
    const auto result = store.find(job.id);
    if (!result || result->outcome != JobOutcome::kDone) continue;
    if (invalid_reason(result->sequence)) continue;
    study.estimator = job.estimator.label;
    auto run = read_run(job, store);
    if (!run) return tl::unexpected(run.error());
    study.runs.push_back(std::move(*run));
  }
  const bool any = std::any_of(study.runs.begin(), study.runs.end(),
                               [](const DetectorRun& run) { return !run.scans.empty(); });
  study.warnings = left_out_lines(suite);
  if (study.runs.empty() && !study.warnings.empty()) return failure(study.warnings.front());
  if (!any) {
    return failure(fmt::format("estimator {} made no update with a scan", study.estimator));
  }
  study.scores = score_detectors(study.runs);
  if (study.scores.empty()) {
    return failure(fmt::format("estimator {} reports no index of degeneracy", study.estimator));
  }
  const auto undecided = undecided_levels(study.scores);
  study.warnings.insert(study.warnings.end(), undecided.begin(), undecided.end());
  return study;
}

}  // namespace aims
