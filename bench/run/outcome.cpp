// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/outcome.hpp"

namespace aims {

EstimatorOutcome outcome_of(const TimedEstimator& timed) {
  EstimatorOutcome outcome;
  outcome.name = timed.name();
  outcome.result = timed.estimator().result();
  outcome.map = timed.estimator().map_points();
  outcome.scan_times = timed.scan_times();
  outcome.wall_s = timed.total_seconds();
  return outcome;
}

}  // namespace aims
