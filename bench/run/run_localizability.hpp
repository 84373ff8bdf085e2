// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/metrics/localizability.hpp"
#include "bench/metrics/localizability_scores.hpp"
#include "bench/metrics/posterior_bound.hpp"
#include "bench/metrics/scores.hpp"
#include "core/files/csv.hpp"
#include "core/measurements.hpp"
#include "estimator/interface/estimator.hpp"
#include "sim/robot/truth.hpp"
#include "sim/simulation_config.hpp"

namespace aims {

/// What a run's scans allow to know, by the truth: one localizability and bound per scan.
struct RunLocalizability {
  std::vector<Localizability> scans;
  std::vector<PosteriorBound> bounds;  ///< of a robot that builds its map
  BoundParameters parameters;          ///< that the bounds hold for
};

/// The true parameters of the simulated sensors, as the posterior bound takes them. The white noise
/// of a leg packet is that of the joint rates through a leg of the body's height, halved in
/// variance by the two feet that stand.
BoundParameters bound_parameters(const SimulationConfig& config, const SensorRig& rig);

/// Localizability and posterior bound of the run of that seed; `truth_trajectory` holds the truth's
/// poses.
RunLocalizability run_localizability(const SimulationConfig& config, const SensorRig& rig,
                                     std::uint64_t seed, const Truth& truth,
                                     const Trajectory& truth_trajectory);

/// Posterior bound of IMU and legs alone, in the run that `truth` and `localizability` are of: one
/// entry per scan.
std::vector<PosteriorBound> bounds_without_lidar(const Truth& truth,
                                                 const RunLocalizability& localizability);

/// Half of a scan: how far a stamp may be from the scan that it means.
Duration half_scan(const SimulationConfig& config);

/// Errors of an estimator along the weak axis at each scan.
std::vector<WeakAxisError> weak_axis_errors_of(const EstimatorResult& report,
                                               const Trajectory& truth_trajectory,
                                               const RunLocalizability& localizability,
                                               const ScoreConfig& scoring, Duration tolerance);

/// One row per scan: localizability, degenerate flags and posterior bound.
CsvTable localizability_table(const RunLocalizability& localizability);

}  // namespace aims
