// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "estimator/interface/diagnostics.hpp"
#include "estimator/interface/health.hpp"
#include "estimator/interface/learned.hpp"

namespace aims {

/// Longest time between reported poses while scans are missing, also at the start.
inline constexpr Duration kMaxPoseInterval = 250 * kMillisecond;

/// Estimate so far.
struct EstimatorResult {
  /// T_odom_body at each scan end, or after `kMaxPoseInterval`; starts at identity
  Trajectory trajectory;
  /// The trajectory after loop closing or smoothing, in the same frame; none: not re-optimized.
  std::optional<Trajectory> optimized;
  Diagnostics diagnostics;  ///< one row per scan (empty for `leg`)
  /// Stamps of poses that were not finite or not rigid, and so are not in the trajectory.
  std::vector<Time> invalid_poses;
  std::map<std::string, int> counts;  ///< e.g. late, duplicate, non-finite measurements
  std::vector<HealthRow> health;      ///< in order of time
  /// Why the estimator has ended before its stream, e.g. an exception of one in Python: the rest
  /// holds what came before.
  std::optional<Error> failure;
  double external_cpu_s = 0.0;  ///< CPU time in another process [s]
};

/// Removes all poses, scans and health rows but the last of each, which the next ones refer to.
inline void keep_last_rows(EstimatorResult& result) {
  const auto keep_last = [](auto& rows) {
    if (rows.size() > 1) rows.erase(rows.begin(), rows.end() - 1);
  };
  keep_last(result.trajectory);
  keep_last(result.diagnostics.scans);
  keep_last(result.health);
}

/// Turns a stream of deliveries into a trajectory. Never throws on data, never reads a clock.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// Processes one measurement; call in order of arrival.
  virtual void consume(const Delivery& delivery) = 0;

  /// Processes the measurements still held for reordering, and re-optimizes the trajectory where
  /// the estimator does; call once, after the last delivery.
  virtual void finish() = 0;

  virtual const EstimatorResult& result() const = 0;

  /// `keep_last_rows` of the result, for a caller that has taken them, so that memory does not grow
  /// with the stream; an estimator that needs its own past keeps it.
  virtual void forget_rows() {}

  /// Points of the local map in the odometry frame [m]; empty for an estimator without a map.
  virtual std::vector<Eigen::Vector3f> map_points() const = 0;

  /// What the data so far say about the robot and its sensors; empty for one that learns nothing.
  virtual std::vector<LearnedQuantity> learned() const { return {}; }
};

}  // namespace aims
