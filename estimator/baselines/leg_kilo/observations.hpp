// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/baselines/leg_kilo/config.hpp"
#include "estimator/baselines/leg_kilo/voxel_plane.hpp"

namespace aims::leg_kilo {

/// A foot that stands on the ground, as the joints see it.
struct StandingFoot {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< from the base, body axes [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< J dq/dt, body axes [m/s]
};

/// Whether the sample has joint angles and the rig the lengths of the legs.
bool has_joints(const LegOdometrySample& sample, const SensorRig& rig);

/// Contacts from forces, with a threshold to begin and a lower one to end. At first all feet are in
/// contact, as in the published program.
class ContactHysteresis {
 public:
  /// Forces that begin and end a contact [N].
  ContactHysteresis(double begin, double end) : begin_(begin), end_(end) {}

  /// The contacts after the next sample: by its forces, else as it reports them.
  const std::array<bool, kLegCount>& update(const LegOdometrySample& sample);

 private:
  double begin_;
  double end_;
  std::array<bool, kLegCount> contact_ = {true, true, true, true};
};

/// The feet in contact, by their joints.
std::vector<StandingFoot> feet_in_contact(const LegOdometrySample& sample, const SensorRig& rig);

/// Four feet under the hips, all standing: the joints that would report the sample's twist.
std::vector<StandingFoot> feet_of_twist(const LegOdometrySample& sample, const SensorRig& rig);

/// An IMU reading, with the specific force scaled to the length of gravity.
struct Inertial {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< body axes [m/s^2]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< body axes [rad/s]
};

/// An IMU reading and the feet that stand at its stamp: the specific force is f + b_a, the rate
/// w + b_g, and of each foot 0 = v + R (w x p + J dq/dt).
Observation inertial_observation(const State& x, const Inertial& reading,
                                 std::span<const StandingFoot> feet, const ImuVariances& imu,
                                 double foot_variance);

/// A point of the scan at a state.
struct ScanPoint {
  Eigen::Vector3d in_body = Eigen::Vector3d::Zero();          ///< [m]
  Eigen::Vector3d in_world = Eigen::Vector3d::Zero();         ///< [m]
  Eigen::Matrix3d beam_covariance = Eigen::Matrix3d::Zero();  ///< of range and beam, world [m^2]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();       ///< and of the pose, world [m^2]
};

/// The point `p_lidar` [m] of a LiDAR mounted at `T_body_lidar`. Range and direction of the beam
/// have the deviations of `noise`; the covariance of the pose is taken without that between
/// rotation and position, as the published program does.
ScanPoint scan_point(const Eigen::Vector3d& p_lidar, const Pose& T_body_lidar, const Belief& belief,
                     const PointNoise& noise);

/// A point and the plane that it should lie on.
struct PointOnPlane {
  Eigen::Vector3d in_body = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of the plane, world
  double distance = 0.0;                              ///< of the point from the plane, signed [m]
  double variance = 0.0;                              ///< of that distance, beam and plane [m^2]
};

/// The row of each: measured - expected = -distance, with `variance_factor` times the variance.
PoseObservation point_observation(const State& x, std::span<const PointOnPlane> points,
                                  double variance_factor);

}  // namespace aims::leg_kilo
