// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/calibration_runs.hpp"

#include <fmt/format.h>

#include <utility>

#include "bench/jobs/sequence_cache.hpp"
#include "bench/run/sequence.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {
Result<CalibrationRun> calibration_run(const Scenario& scenario, std::uint64_t seed,
                                       const std::filesystem::path& cache_folder,
                                       const PartObserver& observer) {
  const Scenario drawn = scenario_of_seed(scenario, seed);
  const SequenceCache cache(cache_folder.empty() ? SequenceCache::default_folder() : cache_folder);
  const auto made = cache.make(drawn, seed, observer, 2);
  if (!made) return tl::unexpected(made.error());
  const std::string name = fmt::format("{} seed {}", scenario.name, seed);
  if (made->refusal) return failure(name + ": " + *made->refusal);
  const auto sequence =
      open_sequence(cache.file_of(SequenceCache::id_of(drawn, seed)), drawn, seed);
  if (!sequence) return tl::unexpected(sequence.error());
  if (const auto reason = invalid_reason(sequence->walk, to_seconds(sequence->end()))) {
    return failure(name + ": " + *reason);
  }
  const auto outcome = evaluate(*sequence, drawn, drawn.run.front(), observer);
  if (!outcome) return tl::unexpected(outcome.error());
  return CalibrationRun{name, sensors_of(sequence->reader.rig(), {}), outcome->learned};
}

Result<CalibrationRun> calibration_run(const EstimateConfig& config, const EstimateOptions& options,
                                       const Observer& observer) {
  const auto result = estimate(config, options, observer);
  if (!result) return tl::unexpected(result.error());
  if (result->estimators.empty()) {
    return failure(options.bag.string() + ": nothing was estimated");
  }
  return CalibrationRun{options.bag.filename().string(), calibrated_sensors(result->setup),
                        result->estimators.front().learned};
}

}  // namespace aims
