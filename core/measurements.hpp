// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "core/leg_geometry.hpp"
#include "core/lie.hpp"
#include "core/time.hpp"

namespace aims {

/// What one inertial sample represents.
enum class ImuSampling {
  kMean,   ///< the mean over the interval that ends at its stamp, as with a real IMU's filter
  kPoint,  ///< the value at its stamp: footfalls alias into it
};

/// One inertial sample in the body (IMU) frame.
struct ImuSample {
  Time stamp = 0;  ///< end of the interval that the sample averages, or the instant sampled
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();  ///< [m/s^2], +9.81 upwards when static
  /// R_world_body as the IMU reports it, a unit quaternion; none: it reports no orientation.
  std::optional<Eigen::Quaterniond> orientation = std::nullopt;
};

/// One LiDAR return in the LiDAR frame at the instant of its own firing (not deskewed).
struct LidarPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< [m]
  float intensity = 0.0F;                              ///< [0, 1]
  std::int32_t time_offset_ns = 0;                     ///< firing time after the scan's stamp [ns]
  std::uint16_t ring = 0;                              ///< 0 = lowest elevation
};

/// One scan in the sensor's firing order; misses are absent.
struct LidarScan {
  Time stamp = 0;  ///< time of the first firing
  Time end = 0;    ///< nominal end of the scan
  std::vector<LidarPoint> points;
};

inline constexpr int kLegCount = 4;     ///< order: front left, front right, rear left, rear right
inline constexpr int kJointCount = 12;  ///< per leg: abduction, hip, knee

using FootLoads = std::array<double, kLegCount>;  ///< normal force on each foot [N]

/// Leg odometry as a robot reports it: pose in its own odometry frame, twist of its base.
struct LegOdometrySample {
  Time stamp = 0;
  Pose T_odom_base;                                           ///< base in the odometry frame
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();  ///< of the base, in base axes [m/s]
  Eigen::Vector3d angular_velocity =
      Eigen::Vector3d::Zero();                            ///< of the base, in base axes [rad/s]
  std::array<bool, kLegCount> contact{};                  ///< detected contacts
  std::array<double, kJointCount> joint_position{};       ///< encoders [rad]
  std::array<double, kJointCount> joint_velocity{};       ///< encoders [rad/s]
  std::optional<FootLoads> contact_force = std::nullopt;  ///< measured; none: not reported
};

using LidarScanPtr = std::shared_ptr<const LidarScan>;
using Measurement = std::variant<ImuSample, LegOdometrySample, LidarScanPtr>;

/// A measurement and the instant at which it reached the estimator (link delay included).
struct Delivery {
  Time arrival = 0;
  Measurement measurement;
};

/// End of the measurement: sample stamp, or end of the scan.
Time stamp_of(const Measurement& measurement);

/// What an estimator needs of the robot and its sensors.
/// The body frame is the IMU frame: x forward, y left, z up.
struct SensorRig {
  Pose T_body_lidar;           ///< LiDAR frame in the body frame
  Pose T_body_base;            ///< frame of the leg odometry (trunk centre) in the body frame
  LegGeometry leg_geometry;    ///< of the robot
  double imu_rate_hz = 50.0;   ///< nominal sample rate [Hz]
  double leg_rate_hz = 200.0;  ///< nominal packet rate of the leg odometry [Hz]
};

}  // namespace aims
