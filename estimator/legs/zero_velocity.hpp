// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/imu_noise.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// The detection looks at windows of this length, and each gives one measurement.
inline constexpr Duration kStandingWindow = 300 * kMillisecond;

/// Noise of the zero velocity [m/s] and the zero mean rate [rad/s] of a standing robot.
inline constexpr double kSigmaZeroVelocity = 0.01;
inline constexpr double kSigmaZeroRate = 3e-3;

/// Zero-velocity update (ZUPT).
struct ZeroVelocityConfig {
  bool enabled = false;
};

void describe(Fields& fields, ZeroVelocityConfig& config);

/// Means of the IMU over a window, and the largest deviations from them.
struct ImuStatistics {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< mean [rad/s], gyro bias included
  double rate_deviation = 0.0;                     ///< largest, of one sample [rad/s]
  double force_deviation = 0.0;                    ///< largest, of one sample [m/s^2]
};

/// Statistics of the samples in (end - window, end]; empty when they do not cover it.
std::optional<ImuStatistics> imu_statistics(std::span<const ImuSample> samples, Time end,
                                            Duration window);

/// Zero velocity of the body: the residual is its velocity in body axes [m/s].
LinearMeasurement zero_velocity_model(const NominalState& state, double sigma);

/// Zero angular rate: the residual is the gyro bias minus the mean reading `rate` [rad/s].
LinearMeasurement zero_rate_model(const NominalState& state, const Eigen::Vector3d& rate,
                                  double sigma);

/// Detects standing still from IMU and legs; both must agree, with hysteresis.
class ZeroVelocityDetector {
 public:
  /// Adds a leg sample, with the IMU samples up to it; `gyro_bias` is the current estimate [rad/s],
  /// `white` the deviation of one IMU sample, whose least so far is what a standing robot shows.
  /// True while the robot stands.
  bool update(const LegOdometrySample& legs, std::span<const ImuSample> imu,
              const Eigen::Vector3d& gyro_bias, const WhiteDeviation& white = {});

  /// The IMU statistics if a measurement is due: one per window, since neighbouring samples share
  /// their errors.
  std::optional<ImuStatistics> due_measurement();

 private:
  bool legs_still(const LegOdometrySample& legs, double factor);

  bool imu_still(const Eigen::Vector3d& gyro_bias, double factor) const;

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
