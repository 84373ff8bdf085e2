// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "bench/metrics/unknown_map_bound.hpp"
#include "core/measurements.hpp"
#include "sim/robot/truth.hpp"
#include "sim/simulation_config.hpp"

namespace aims {

/// The map of a run in parts, and what each scan measures of them.
struct MapViews {
  std::vector<Eigen::Vector3d> centres;  ///< of the parts, along the true path [m]
  std::vector<ScanView> scans;           ///< as the truth's; their sums are its information
};

/// Splits the map at the true path into at most `max_parts` parts of at least `spacing` [m]: a
/// surface belongs to the part whose centre is nearest. Which part of a scan's recorded information
/// comes from which part of the map follows from scans of fewer firings, cast again into the true
/// scene of that seed wherever the robot has moved or turned on since the last.
MapViews map_views(const SimulationConfig& config, const SensorRig& rig, std::uint64_t seed,
                   const Truth& truth, double spacing = 2.0, std::size_t max_parts = 16);

}  // namespace aims
