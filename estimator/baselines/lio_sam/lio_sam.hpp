// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/attitude_filter.hpp"
#include "core/config.hpp"
#include "estimator/baselines/lio_sam/mapping.hpp"
#include "estimator/baselines/lio_sam/scan_features.hpp"
#include "estimator/filter/measurement_queue.hpp"
#include "estimator/filter/queued_estimator.hpp"
#include "estimator/interface/diagnostics.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims::lio_sam {

/// When the published program's parts get what the others have made. They run at the same time; an
/// estimator without a clock needs rules.
struct TimingConfig {
  int held_scans = 2;   ///< a scan is processed when this many later ones have ended
  double delay = 0.05;  ///< until a registered scan reaches the IMU odometry [s]
};

void describe(Fields& fields, TimingConfig& config);

/// Configuration of LIO-SAM; the defaults are those published.
struct Config {
  ImageConfig image;
  FeatureConfig features;
  MappingConfig mapping;
  ImuOdometryConfig imu;
  TimingConfig timing;
  QueueConfig queue;
};

void describe(Fields& fields, Config& config);

Requirements requirements_of(const Config& config);

/// The published voxel sizes for indoors, and returns from 0.5 m on: the walls of a corridor are
/// nearer than the published 1 m.
Config corridor();

/// What LIO-SAM reports of a scan.
struct ScanReport {
  int points_in = 0;     ///< returns in range
  bool guessed = false;  ///< the IMU odometry gave the guess
  std::optional<RegisteredScan> registered;
  int resets = 0;                   ///< failures of the IMU odometry so far
  int loops = 0;                    ///< loops closed so far
  double speed = 0.0;               ///< of the newest key [m/s]
  double accelerometer_bias = 0.0;  ///< likewise [m/s^2]
  double gyro_bias = 0.0;           ///< likewise [rad/s]
};

/// LIO-SAM: scans registered to keyframes, guessed by an odometry of IMU and LiDAR poses in a
/// factor graph; keyframes in another graph, with loops (docs/baselines/lio_sam.md). Its odometry
/// frame is level, at the body's first position and heading.
class LioSam final : public QueuedEstimator {
 public:
  LioSam(const Config& config, const SensorRig& rig);

  void finish() override;
  std::vector<Eigen::Vector3f> map_points() const override;

 private:
  /// A registered scan on its way to the IMU odometry.
  struct Pending {
    Time arrival = 0;
    LidarOdometry scan;
  };

  /// Holds the scan until later ones have come, whose IMU samples are known then.
  void process_scan(const LidarScanPtr& scan) override;
  void end_delivery() override { set_counts(); }
  void add_samples(Time until);
  void add_sample(const ImuSample& sample);
  ImuSample in_lidar_axes(const ImuSample& sample);
  void process(const LidarScan& scan, Time clock);
  bool covered_by_imu(const LidarScan& scan, Time last_firing) const;
  ScanPrior prior_of(const LidarScan& scan, const GyroRotation& rotation);
  std::optional<Pose> odometry_at(Time begin);
  Pose between_scans(Time stamp);
  void report(const LidarScan& scan, const Pose& T_map_lidar, const ScanReport& diagnostics);
  void set_counts();

  Config config_;
  AttitudeFilter attitude_filter_;
  Mapping mapping_;
  ImuOdometry imu_odometry_;

  std::optional<Time> last_sample_;
  std::deque<LidarScanPtr> held_;
  std::deque<Pending> pending_;
  std::deque<ImuSample> samples_;       ///< for the next scans, LiDAR axes
  std::deque<StampedPose> odometry_;    ///< of the IMU, for the next scans
  std::deque<StampedPose> since_scan_;  ///< likewise, since the last registered scan
  RollPitchYaw attitude_;               ///< last one at a scan's begin
  std::optional<StampedPose> registered_;
  Pose T_odom_map_;
  int without_orientation_ = 0;
  int without_imu_ = 0;
  int rejected_ = 0;
};

}  // namespace aims::lio_sam
