// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "estimator/aims/health_monitor.hpp"
#include "estimator/filter/queued_estimator.hpp"

namespace aims {

/// Configuration of leg odometry alone.
struct LegDeadReckoningConfig {
  double max_speed = 5.0;  ///< faster samples are rejected [m/s]
  QueueConfig queue;
};

void describe(Fields& fields, LegDeadReckoningConfig& config);

Requirements requirements_of(const LegDeadReckoningConfig& config);

/// Leg odometry alone, as the robot reports it: its poses in the body frame, transformed so that
/// the first has zero position and yaw, and interpolated at the end of each scan.
class LegDeadReckoning : public QueuedEstimator {
 public:
  LegDeadReckoning(const LegDeadReckoningConfig& config, const SensorRig& rig);

  void finish() override;
  void forget_rows() override { keep_last_rows(result_); }
  std::vector<Eigen::Vector3f> map_points() const override { return {}; }

 private:
  void process_legs(const LegOdometrySample& sample) override;
  void process_scan(const LidarScanPtr& scan) override;
  void end_delivery() override { judge_health(); }
  void judge_health();
  HealthRow judged_health(Time now);

  HealthMonitor health_;
  std::optional<Time> start_;   ///< stamp of the first sample
  std::optional<Time> judged_;  ///< arrival
  double speed_ = 0.0;          ///< largest between two samples since the last judgement [m/s]
  std::optional<Pose> T_start_odom_;
  std::optional<StampedPose> last_;  ///< T_start_body
  std::vector<Time> waiting_;        ///< scan ends after the last sample
};

}  // namespace aims
