// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include "bench/estimate/estimate.hpp"
#include "bench/estimate/robot_calibration.hpp"
#include "bench/run/evaluate.hpp"
#include "bench/scenario/scenario.hpp"

namespace aims {

/// What the first estimator of the scenario learns of the robot on that seed. The sequence is
/// simulated unless it is in the `cache` (empty: the default folder). Error when the scenario
/// cannot be simulated, or the robot falls.
Result<CalibrationRun> calibration_run(const Scenario& scenario, std::uint64_t seed,
                                       const std::filesystem::path& cache,
                                       const PartObserver& observer);

/// The same from a recording.
Result<CalibrationRun> calibration_run(const EstimateConfig& config, const EstimateOptions& options,
                                       const Observer& observer);

}  // namespace aims
