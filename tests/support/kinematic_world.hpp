// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/measurements.hpp"
#include "core/random.hpp"
#include "core/trajectory.hpp"

namespace aims::test {

/// A straight corridor along x with door recesses on its left wall, in closed form.
struct CorridorShape {
  double begin = -1.5;         ///< x of the near end wall [m]
  double end = 80.1;           ///< x of the far end wall [m]
  double width = 2.2;          ///< [m]
  double height = 2.6;         ///< [m]
  double door_spacing = 8.0;   ///< 0: no doors [m]
  double first_door = -1e9;    ///< no doors before this x [m]
  double door_width = 0.9;     ///< [m]
  double door_height = 2.1;    ///< [m]
  double recess_depth = 0.15;  ///< [m]
  bool open_ends = false;      ///< no end walls
};

/// A walk without physics: stand, walk a distance, turn, walk back, with the bob of a trot.
struct WalkPlan {
  double distance = 78.6;  ///< [m]
  double speed = 0.7;      ///< [m/s]
  double stand = 2.0;      ///< before the first step [s]
  bool there_and_back = true;
  double bob = 1.0;  ///< factor on the trot's oscillations [-]
};

struct KinematicSensors {
  double lidar_range = 100.0;  ///< [m]
  double lidar_noise = 0.02;   ///< [m]
  int lidar_columns = 1800;
  double lidar_grazing_sine = 0.02;  ///< returns flatter than this to the wall are lost [-]
  double gyro_noise = 0.004;         ///< of one sample [rad/s]
  double force_noise = 0.04;         ///< of one sample [m/s^2]
  double gyro_bias = 0.002;          ///< deviation over seeds [rad/s]
  double force_bias = 0.02;          ///< deviation over seeds [m/s^2]
  double leg_scale_error = 0.045;    ///< legs report too short by this [-]
  double leg_noise = 0.05;           ///< white, of one sample [m/s]
  double leg_slow_noise = 0.03;      ///< correlated over 0.2 s [m/s]
  double leg_loss = 0.04;            ///< probability of losing a packet [-]
};

struct KinematicConfig {
  CorridorShape corridor;
  WalkPlan walk;
  KinematicSensors sensors;
  std::uint64_t seed = 1;
};

/// Distance along the unit `direction` from `origin`, inside the corridor, to its surface, and the
/// sine of the angle between ray and surface; negative distance when the ray leaves an open end.
struct RayHit {
  double distance = -1.0;
  double grazing_sine = 0.0;
};
RayHit cast_ray(const CorridorShape& corridor, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction);

/// Streams what the sensors of the walking robot deliver.
class KinematicWorld {
 public:
  explicit KinematicWorld(const KinematicConfig& config);

  /// Appends the deliveries of the next `span`, in order of arrival; false once the walk is done.
  bool advance(Duration span, std::vector<Delivery>& deliveries);

  /// The true pose at an instant; the world's origin is the floor below the start.
  Pose T_world_body(Time stamp) const;

  const SensorRig& rig() const { return rig_; }
  Duration duration() const { return from_seconds(duration_); }
  Time turn_time() const { return from_seconds(leg_end_); }

 private:
  Pose pose(double t) const;
  Eigen::Vector3d velocity(double t) const;
  Eigen::Vector3d angular_velocity(double t) const;
  ImuSample imu(Time stamp);
  LegOdometrySample legs(Time stamp);
  LidarScanPtr scan(Time end);

  KinematicConfig config_;
  SensorRig rig_;
  double walk_time_ = 0.0;
  double leg_end_ = 0.0;
  double back_start_ = 0.0;
  double duration_ = 0.0;
  Time now_ = 0;
  Eigen::Vector3d gyro_bias_;
  Eigen::Vector3d force_bias_;
  Eigen::Vector3d slow_noise_ = Eigen::Vector3d::Zero();
  Pose T_odom_base_;
  RandomStream imu_random_;
  RandomStream leg_random_;
  RandomStream loss_random_;
  RandomStream lidar_random_;
};

/// A walk of 2.5 m there and back in a box of 21.5 m, with a coarse LiDAR: quick to simulate.
KinematicConfig short_walk();

/// All deliveries of the walk.
std::vector<Delivery> record(KinematicWorld& world);

/// The odometry frame of an estimate in the world, by its first pose.
Pose T_world_odom(const Trajectory& estimate, const KinematicWorld& world);

/// Largest distance between an estimate, aligned at its first pose, and the truth; infinite for one
/// that is not finite [m].
double largest_error(const Trajectory& estimate, const KinematicWorld& world);

}  // namespace aims::test
