// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/evaluate.hpp"

#include <utility>
#include <vector>

#include "bench/run/stream.hpp"

namespace aims {

Result<RecordedWalk> open_walk(const std::filesystem::path& file, const Scenario& scenario) {
  auto reader = WalkReader::open(file);
  if (!reader) return tl::unexpected(reader.error());
  RecordedWalk walk{std::move(*reader), {}};
  Truth truth = walk.reader.release_truth();
  walk.run.complete = true;
  walk.run.truth_trajectory = body_trajectory(truth);
  walk.run.localizability =
      run_localizability(scenario.simulation, walk.reader.rig(), truth, walk.run.truth_trajectory);
  walk.run.truth.waypoint_times =
      std::move(truth.waypoint_times);  // samples and sweeps served above
  return walk;
}

Result<EstimatorOutcome> evaluate(const RecordedWalk& walk, const Scenario& scenario,
                                  const std::string& estimator) {
  const std::vector<std::string> specs = {estimator};
  auto estimators = make_estimators(specs, scenario.estimator, walk.reader.rig());
  if (!estimators) return tl::unexpected(estimators.error());
  TimedEstimator& timed = estimators->front();
  const auto replayed = walk.reader.replay([&](const Delivery& delivery) {
    timed.consume({&delivery, 1});
  });
  if (!replayed) return tl::unexpected(replayed.error());
  timed.finish();
  return outcome_of(timed, walk.run, scenario);
}

}  // namespace aims
