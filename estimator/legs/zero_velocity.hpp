// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/imu_noise.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Zero-velocity update (ZUPT).
struct ZeroVelocityConfig {
  bool enabled = false;
  double window = 0.3;               ///< of the detection; one measurement per window [s]
  double max_rate = 0.03;            ///< mean angular rate, and deviation from the mean [rad/s]
  double max_force_deviation = 0.3;  ///< of the specific force from its mean [m/s^2]
  double max_leg_speed = 0.02;       ///< speed from leg odometry, smoothed [m/s]
  double max_joint_rate = 0.15;      ///< root mean square over the joints, smoothed [rad/s]
  double leg_smoothing = 0.05;       ///< time constant of both [s]
  double hysteresis = 1.5;           ///< factor on the limits once the robot stands [-]
  double sigma_velocity = 0.01;      ///< of the zero velocity [m/s]
  double sigma_rate = 3e-3;          ///< of the zero mean rate [rad/s]
};

void describe(Fields& fields, ZeroVelocityConfig& config);

/// Means of the IMU over a window, and the largest deviations from them.
struct ImuStatistics {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< mean [rad/s], gyro bias included
  double rate_deviation = 0.0;                     ///< largest, of one sample [rad/s]
  double force_deviation = 0.0;                    ///< largest, of one sample [m/s^2]
};

/// Statistics of the samples in (end - window, end]; empty when they do not cover it.
std::optional<ImuStatistics> imu_statistics(const std::deque<ImuSample>& samples, Time end,
                                            Duration window);

/// Zero velocity of the body: the residual is its velocity in body axes [m/s].
LinearMeasurement zero_velocity_model(const NominalState& state, double sigma);

/// Zero angular rate: the residual is the gyro bias minus the mean reading `rate` [rad/s].
LinearMeasurement zero_rate_model(const NominalState& state, const Eigen::Vector3d& rate,
                                  double sigma);

/// Detects standing still from IMU and legs; both must agree, with hysteresis.
class ZeroVelocityDetector {
 public:
  explicit ZeroVelocityDetector(const ZeroVelocityConfig& config) : config_(config) {}

  /// Adds a leg sample, with the IMU samples up to it; `gyro_bias` is the current estimate [rad/s],
  /// `white` the deviation of one IMU sample, whose least so far is what a standing robot shows.
  /// True while the robot stands.
  bool update(const LegOdometrySample& legs, const std::deque<ImuSample>& imu,
              const Eigen::Vector3d& gyro_bias, const WhiteDeviation& white = {});

  /// The IMU statistics if a measurement is due: one per window, since neighbouring samples share
  /// their errors.
  std::optional<ImuStatistics> due_measurement();

 private:
  bool legs_still(const LegOdometrySample& legs, double factor);

  bool imu_still(const Eigen::Vector3d& gyro_bias, double factor) const;

  ZeroVelocityConfig config_;
  std::optional<WhiteDeviation> quiet_;  ///< the least so far
  bool standing_ = false;
  Eigen::Vector3d smoothed_velocity_ = Eigen::Vector3d::Zero();  ///< from leg odometry [m/s]
  double smoothed_joint_square_ = 0.0;                           ///< mean square [rad^2/s^2]
  std::optional<Time> last_;
  std::optional<Time> still_since_;
  std::optional<Time> last_measured_;
  std::optional<ImuStatistics> statistics_;
};

}  // namespace aims
