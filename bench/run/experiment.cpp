// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/experiment.hpp"

#include <fmt/format.h>

#include "bench/run/results.hpp"
#include "bench/run/summary.hpp"
#include "core/files/output_folder.hpp"
#include "core/stopwatch.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Wall time [s] that drawing took; a picture that could not be drawn costs no results.
double draw(const Scenario& scenario, const RunResult& result, const fs::path& folder,
            std::vector<std::string>& warnings) {
  const Stopwatch stopwatch;
  if (auto drawn = draw_pictures(scenario, result, folder); !drawn) {
    warnings.push_back(drawn.error().message);
  }
  return stopwatch.seconds();
}

/// Runs one seed and adds it to the experiment.
Result<void> run_seed(const Scenario& scenario, const ExperimentOptions& options,
                      std::uint64_t seed, const fs::path& folder,
                      const ExperimentObserver& observer, Experiment& experiment) {
  const auto result = run(scenario, {seed, options.jobs},
                          [&](const Progress& progress) { return observer(seed, progress); });
  if (!result) return tl::unexpected(result.error());
  const double drawing_s =
      options.pictures ? draw(scenario, *result, folder, experiment.warnings) : 0.0;
  RunRecord record = record_of(scenario, *result, drawing_s);
  if (auto written = write_results(scenario, *result, record, folder); !written) return written;
  experiment.complete = result->complete;
  experiment.runs.push_back(std::move(record));
  return {};
}

}  // namespace

Result<Experiment> run_experiment(const Scenario& scenario, const ExperimentOptions& options,
                                  const ExperimentObserver& observer) {
  auto folder = OutputFolder::create(options.out, options.overwrite);
  if (!folder) return tl::unexpected(folder.error());
  const bool several = options.seeds.size() > 1;
  Experiment experiment;
  for (const std::uint64_t seed : options.seeds) {
    const fs::path run_folder =
        several ? folder->path() / fmt::format("seed-{}", seed) : folder->path();
    fs::create_directories(run_folder);
    auto done = run_seed(scenario, options, seed, run_folder, observer, experiment);
    if (!done) return tl::unexpected(done.error());
    if (!experiment.complete) break;
  }
  if (experiment.complete) experiment.failures = failed(check_gates(scenario, experiment.runs));
  if (several) {
    if (auto written = write_summary(scenario, experiment.runs, folder->path()); !written) {
      return tl::unexpected(written.error());
    }
  }
  if (auto committed = folder->commit(); !committed) return tl::unexpected(committed.error());
  experiment.folder = folder->final_path();
  return experiment;
}

}  // namespace aims
