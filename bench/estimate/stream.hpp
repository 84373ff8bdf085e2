// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/scoring/timed_estimator.hpp"
#include "core/error.hpp"
#include "core/measurements.hpp"
#include "estimator/registry.hpp"

namespace aims {

/// Stream handed over between a source and the estimators at a time: bounds the memory of a run.
inline constexpr Duration kStreamBatch = kSecond;

/// Appends the deliveries of the next batch; false when it is the last one.
using NextBatch = std::function<Result<bool>(std::vector<Delivery>& batch)>;

/// How a stream ended: by itself when both are empty.
struct StreamEnd {
  bool stopped = false;        ///< the caller had enough
  std::optional<Error> error;  ///< the source broke; what came before it was estimated
};

/// The estimators that the specs ask for (estimator/estimator_spec.hpp), each under its label and
/// with its settings on top of `configs`. Error for a spec that cannot be read.
Result<std::vector<TimedEstimator>> make_estimators(std::span<const std::string> specs,
                                                    const EstimatorConfigs& configs,
                                                    const SensorRig& rig);

/// Hands every batch to every estimator on `jobs` threads; while they work on one, the next is
/// made. After each, `wanted` says whether to go on. The results do not depend on `jobs`.
StreamEnd stream(const NextBatch& next_batch, std::vector<TimedEstimator>& estimators, int jobs,
                 const std::function<bool()>& wanted);

}  // namespace aims
