// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/evaluate.hpp"

#include <utility>
#include <vector>

#include "bench/run/stream.hpp"

namespace aims {

Result<Sequence> open_sequence(const std::filesystem::path& file, const Scenario& scenario) {
  auto reader = SequenceReader::open(file);
  if (!reader) return tl::unexpected(reader.error());
  Sequence sequence{std::move(*reader), {}};
  Truth truth = sequence.reader.release_truth();
  sequence.run.complete = true;
  sequence.run.truth_trajectory = body_trajectory(truth);
  sequence.run.localizability =
      run_localizability(scenario.simulation, sequence.reader.rig(), truth, sequence.run.truth_trajectory);
  sequence.run.truth.waypoint_times =
      std::move(truth.waypoint_times);  // samples and sweeps served above
  return sequence;
}

Result<EstimatorOutcome> evaluate(const Sequence& sequence, const Scenario& scenario,
                                  const std::string& estimator) {
  const std::vector<std::string> specs = {estimator};
  auto estimators = make_estimators(specs, scenario.estimator, sequence.reader.rig());
  if (!estimators) return tl::unexpected(estimators.error());
  TimedEstimator& timed = estimators->front();
  const auto replayed = sequence.reader.replay([&](const Delivery& delivery) {
    timed.consume({&delivery, 1});
  });
  if (!replayed) return tl::unexpected(replayed.error());
  timed.finish();
  return outcome_of(timed, sequence.run, scenario);
}

}  // namespace aims
