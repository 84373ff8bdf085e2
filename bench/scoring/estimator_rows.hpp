// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "bench/scoring/health_time.hpp"
#include "core/trajectory.hpp"
#include "estimator/diagnostics.hpp"
#include "estimator/health.hpp"

namespace aims {

/// Consecutive rows of what an estimator reports, valid until its next measurement.
struct EstimatorRows {
  std::span<const StampedPose> poses;  ///< T_odom_body
  std::span<const SeriesInfo> series;  ///< of the scans
  std::span<const ScanRow> scans;
  std::span<const double> wall_ms;  ///< of the scans, from the first; may be fewer [ms]
  std::span<const HealthRow> health;
};

/// What is kept of all rows of an estimator; its memory does not grow with their number.
struct EstimatorTotals {
  std::size_t poses = 0;
  std::size_t scans = 0;
  double path_m = 0.0;  ///< sum of the distances from pose to pose
  Pose first_pose;      ///< T_odom_body; identity without poses, as the last one
  Pose last_pose;
  HealthSummary health;
};

/// Adds the rows that follow those added before.
void add_rows(const EstimatorRows& rows, EstimatorTotals& totals);

}  // namespace aims
