// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/run/evaluate.hpp"
#include "bench/scenario/scenario.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/sensors/lidar.hpp"

namespace aims {

/// What holds a run along the weak axis of its scene with plain surfaces, by source, in equivalent
/// returns (docs/glossary.md). Medians over scans 1 m apart, for a known map. Each is a
/// bound: what an estimator could know that used the source alone without any loss.
struct WeakDirection {
  std::string scenario;
  std::uint64_t seed = 0;
  double range_sigma = 0.0;  ///< of the unit [m]
  double planes = 0.0;       ///< the scene with plain surfaces
  double relief = 0.0;       ///< what relief and joints of boards add
  double intensity = 0.0;    ///< what the texture of the reflectivity adds
  double legs = 0.0;         ///< of the last metre walked: the error of `leg_inertial` over 1 m
  double believed = 0.0;     ///< that `aims_d` stated
};

/// Casts the run's scans again into its scene with and without `scene.surface`, and runs
/// `leg_inertial` and `aims_d` on its sequence. Error for what cannot be simulated.
Result<WeakDirection> weak_direction(const Scenario& scenario, std::uint64_t seed,
                                     const std::filesystem::path& cache,
                                     const PartObserver& observer);

/// The rows of measurements of log intensities, in the form of the truth of a scan, whose
/// `scan_information` with a range noise of 1 is their information about the pose. A hit moves by w
/// = (1 - d n^T / (n . d)) (t + r x p) when the sensor moves by (r, t), so that the logarithm of
/// its intensity changes by g . w with the gradient g of the logarithm of the reflectivity. Its
/// noise is `intensity_sigma`, and step / sqrt(12) of the intensity. Differences of the texture
/// over 4 cm give g; that of range and incidence is left out, as are returns beside an edge.
ScanTruth intensity_rows(const RayCaster& caster, const LidarConfig& config, const LidarScan& scan,
                         const ScanTruth& hits, const Eigen::Vector3d& p_world_lidar);

/// Median over the runs of each scenario.
TextTable weak_direction_table(const std::vector<WeakDirection>& runs);

/// Writes weak.md, weak.csv (a row per run) into `folder`.
Result<void> write_weak_direction(const std::vector<WeakDirection>& runs,
                                  const std::filesystem::path& folder);

}  // namespace aims
