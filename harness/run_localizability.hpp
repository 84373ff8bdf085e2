// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/estimator.hpp"
#include "eval/localizability.hpp"
#include "eval/localizability_scores.hpp"
#include "eval/posterior_bound.hpp"
#include "eval/scores.hpp"
#include "io/csv.hpp"
#include "sim/simulation_config.hpp"
#include "sim/truth.hpp"

namespace aims {

/// What a run's sweeps allow to know, by the truth: one entry of each per sweep.
struct RunLocalizability {
  std::vector<Localizability> scans;
  std::vector<PosteriorBound> bounds;
  std::vector<PosteriorBound> bounds_without_lidar;  ///< of IMU and legs alone
};

/// The true parameters of the simulated sensors, as the posterior bound takes them. The white noise
/// of a leg packet is that of the joint rates through a leg of the body's height, halved in
/// variance by the two feet that stand.
BoundParameters bound_parameters(const SimulationConfig& config, const SensorRig& rig);

/// Localizability and posterior bound of a run; `truth_trajectory` holds the truth's poses.
RunLocalizability run_localizability(const SimulationConfig& config, const SensorRig& rig,
                                     const Truth& truth, const Trajectory& truth_trajectory);

/// Half of a sweep: how far a stamp may be from the sweep that it means.
Duration half_sweep(const SimulationConfig& config);

/// Errors of an estimator along the weak axis at each sweep.
std::vector<WeakAxisError> weak_axis_errors_of(const EstimatorReport& report,
                                               const Trajectory& truth_trajectory,
                                               const RunLocalizability& localizability,
                                               const ScoreConfig& scoring, Duration tolerance);

/// One row per sweep: localizability, degenerate flags and posterior bound.
CsvTable localizability_table(const RunLocalizability& localizability);

}  // namespace aims
