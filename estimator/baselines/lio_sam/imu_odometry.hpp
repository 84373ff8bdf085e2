// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "estimator/baselines/lio_sam/preintegration.hpp"

namespace aims::lio_sam {

/// Odometry at the rate of the IMU (LIO-SAM, section III-B); defaults of the published program.
struct ImuOdometryConfig {
  ImuNoiseConfig noise;
  double gravity = 9.80511;            ///< [m/s^2]
  double prior_pose_sigma = 1e-2;      ///< of the first pose [rad, m]
  double prior_velocity_sigma = 1e4;   ///< of the first velocity [m/s]
  double prior_bias_sigma = 1e-3;      ///< of the first biases [m/s^2, rad/s]
  double rotation_sigma = 0.05;        ///< of a LiDAR pose [rad]
  double position_sigma = 0.1;         ///< of a LiDAR pose [m]
  double degenerate_sigma = 1.0;       ///< of a LiDAR pose from a degenerate scan [rad, m]
  int max_keys = 100;                  ///< the graph starts anew from its last key then
  double max_speed = 30.0;             ///< a faster estimate is a failure [m/s]
  double max_bias = 1.0;               ///< so is a greater bias [m/s^2, rad/s]
  double relinearize_threshold = 0.1;  ///< see FactorGraph [rad, m, m/s, ...]
};

void describe(Fields& fields, ImuOdometryConfig& config);

/// A registered scan, as the IMU odometry is given it.
struct LidarOdometry {
  Time stamp = 0;  ///< begin of the scan
  Pose T_map_lidar;
  bool degenerate = false;
};

/// Poses between and after registered scans: a graph of LiDAR poses and preintegrated IMU samples
/// yields velocity and biases, from which the newest samples are integrated. Samples and poses are
/// in LiDAR axes; the IMU sits off the LiDAR by a lever.
class ImuOdometry {
 public:
  /// `p_lidar_imu`: position of the IMU in LiDAR axes [m].
  ImuOdometry(const ImuOdometryConfig& config, const Eigen::Vector3d& p_lidar_imu);

  /// Adds the next sample; returns the pose of the LiDAR at its stamp, or nothing before the graph
  /// has been solved once since its start.
  std::optional<StampedPose> add(const ImuSample& sample);

  /// Adds a registered scan, solves, and integrates the samples after it anew.
  void correct(const LidarOdometry& scan);

  /// Of the newest key.
  const NavState& state() const { return state_; }
  const ImuBias& bias() const { return bias_; }

  /// Failures by kind: "odometry.speed", "odometry.bias", "odometry.unsolved".
  const std::map<std::string, int>& failures() const { return failures_; }

 private:
  void start(const LidarOdometry& scan);
  void begin_graph(const Eigen::MatrixXd& pose, const Eigen::MatrixXd& velocity,
                   const Eigen::MatrixXd& bias);
  bool begin_anew();
  void integrate_until(Time stamp);
  bool solve(const LidarOdometry& scan);
  const char* failure() const;
  void fail(const char* kind);
  void integrate_newest(Time stamp);

  ImuOdometryConfig config_;
  Pose T_lidar_imu_;

  std::deque<ImuSample> unsolved_;  ///< not yet in a factor
  std::optional<Time> last_unsolved_;
  Preintegration motion_;  ///< since the last key

  bool started_ = false;
  std::optional<FactorGraph> graph_;
  std::vector<Key> keys_;
  NavState state_;
  ImuBias bias_;

  bool solved_ = false;
  std::deque<ImuSample> newest_;  ///< since the last registered scan
  std::optional<Time> last_newest_;
  Preintegration newest_motion_;

  std::map<std::string, int> failures_;
};

}  // namespace aims::lio_sam
