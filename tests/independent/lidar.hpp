// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"
#include "tests/independent/motion.hpp"
#include "tests/independent/world.hpp"

namespace aims::independent {

inline constexpr Duration kScanPeriod = kSecond / 10;

/// Elevations [deg], lowest first. Names: uneven (16, denser near the horizon), uniform (16, -15 to
/// 15), 32. Error for another name.
Result<std::vector<double>> ring_elevations_deg(std::string_view table);

struct LidarOptions {
  std::vector<double> elevations_deg;
  int columns = 1800;         ///< of a revolution
  double min_range = 0.3;     ///< [m]
  double max_range = 30.0;    ///< [m]
  double range_noise = 0.02;  ///< [m]
  double outliers = 0.002;    ///< fraction of returns, at a random shorter range
  std::uint64_t seed = 1;
};

/// A spinning LiDAR, clockwise seen from above, first firing to the rear.
class SpinningLidar {
 public:
  SpinningLidar(const Pose& T_body_lidar, LidarOptions options);

  /// The scan that begins at `start`; each column is cast from the pose at its firing time.
  LidarScan scan(const Walk& walk, const World& world, Time start);

 private:
  double measured(double distance);

  Pose T_body_lidar_;
  LidarOptions options_;
  std::vector<Eigen::Vector3d> directions_;  ///< in LiDAR axes, column by column
  RandomStream noise_;
  RandomStream outliers_;
};

}  // namespace aims::independent
