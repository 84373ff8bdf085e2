// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "bench/run/run.hpp"
#include "bench/studies/detector_report.hpp"
#include "bench/studies/detectors.hpp"
#include "core/files/output_folder.hpp"

namespace aims {
namespace {

/// One run to be made.
struct Unit {
  const Scenario* scenario = nullptr;
  std::uint64_t seed = 0;
};

std::string label_of(const Unit& unit) {
  return fmt::format("{} seed {}", unit.scenario->name, unit.seed);
}

/// Runs one estimator through one scenario on the calling thread and keeps what detectors need.
Result<DetectorRun> run_unit(const Unit& unit, const std::string& estimator,
                             const std::atomic<bool>& wanted) {
  Scenario scenario = *unit.scenario;
  scenario.estimators = {estimator};
  const auto result =
      run(scenario, {unit.seed, 1}, [&wanted](const Progress&) { return wanted.load(); });
  if (!result) return tl::unexpected(result.error());
  const EstimatorResult& report = result->estimators.front().result;
  if (report.diagnostics.empty() && !report.trajectory.empty()) {
    return failure(fmt::format("estimator {} records no diagnostics of scans", estimator));
  }
  DetectorRun made = detector_run(report.diagnostics, result->localizability.scans,
                                  half_scan(scenario.simulation));
  made.scenario = scenario.name;
  made.seed = unit.seed;
  return made;
}

/// Makes the runs, up to `jobs` at a time; their order is that of `units` whatever ends first.
class Runner {
 public:
  Runner(const std::vector<Unit>& units, const DetectorOptions& options,
         const DetectorObserver& observer)
      : units_(units), options_(options), observer_(observer), runs_(units.size()) {}

  Result<std::vector<DetectorRun>> make() {
    tbb::task_arena arena(options_.jobs);
    arena.execute([this] {
      tbb::task_group tasks;
      for (int worker = 0; worker < options_.jobs; ++worker) tasks.run([this] { work(); });
      tasks.wait();
    });
    if (error_) return tl::unexpected(*error_);
    if (!wanted_) return failure("interrupted: nothing was written");
    return std::move(runs_);
  }

 private:
  void work() {
    for (std::size_t i = next_++; i < units_.size() && wanted_; i = next_++) {
      // An arena of one: whatever a run waits for, its thread starts no other run meanwhile.
      tbb::task_arena alone(1);
      auto made = alone.execute([&] { return run_unit(units_[i], options_.estimator, wanted_); });
      const std::lock_guard lock(mutex_);
      if (made) {
        runs_[i] = std::move(*made);
        ++done_;
      } else if (!error_) {
        error_ = made.error();
      }
      const bool more = observer_(label_of(units_[i]), done_, static_cast<int>(units_.size()));
      if (error_ || !more) wanted_ = false;
    }
  }

  const std::vector<Unit>& units_;
  const DetectorOptions& options_;
  const DetectorObserver& observer_;
  std::vector<DetectorRun> runs_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> wanted_ = true;
  std::mutex mutex_;  ///< of what follows, and of the observer
  int done_ = 0;
  std::optional<Error> error_;
};

}  // namespace

Result<DetectorStudy> run_detectors(std::span<const Scenario> scenarios,
                                    const DetectorOptions& options,
                                    const DetectorObserver& observer) {
  auto folder = OutputFolder::create(options.out, options.overwrite);
  if (!folder) return tl::unexpected(folder.error());
  std::vector<Unit> units;
  for (const Scenario& scenario : scenarios) {
    for (const std::uint64_t seed : options.seeds) units.push_back({&scenario, seed});
  }
  auto runs = Runner(units, options, observer).make();
  if (!runs) return tl::unexpected(runs.error());
  DetectorStudy study;
  study.runs = std::move(*runs);
  const bool any = std::any_of(study.runs.begin(), study.runs.end(),
                               [](const DetectorRun& run) { return !run.scans.empty(); });
  if (!any) {
    return failure(fmt::format("estimator {} made no update with a scan", options.estimator));
  }
  study.scores = score_detectors(study.runs);
  study.warnings = undecided_levels(study.scores);
  if (auto written = write_detectors(study, options.estimator, folder->path()); !written) {
    return tl::unexpected(written.error());
  }
  if (auto committed = folder->commit(); !committed) return tl::unexpected(committed.error());
  study.folder = folder->final_path();
  return study;
}

}  // namespace aims
