// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/kinematic_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace aims::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kBodyHeight = 0.30;     ///< [m]
constexpr double kStride = 1.0 / 0.433;  ///< trot frequency [Hz]
constexpr double kRamp = 1.0;            ///< to speed and back [s]
constexpr double kTurn = 4.0;            ///< of half a turn [s]
constexpr double kGravity = 9.81;
constexpr Duration kImuPeriod = 20 * kMillisecond;
constexpr Duration kLegPeriod = 5 * kMillisecond;
constexpr Duration kScan = 100 * kMillisecond;

/// Smooth ramp from 0 to 1 over t in [0, 1].
double ease(double t) { return 0.5 * (1.0 - std::cos(kPi * std::clamp(t, 0.0, 1.0))); }

/// Integral of `ease` from 0.
double ease_integral(double t) {
  const double inside = std::clamp(t, 0.0, 1.0);
  return 0.5 * (inside - std::sin(kPi * inside) / kPi) + std::max(t - 1.0, 0.0);
}

/// Distance walked `t` after the start of a walk that takes `total`.
double progress(double t, double total, double speed) {
  return speed * kRamp * (ease_integral(t / kRamp) - ease_integral((t - total + kRamp) / kRamp));
}

/// Share of the full speed at that instant.
double effort(double t, double total) {
  return ease(t / kRamp) - ease((t - total + kRamp) / kRamp);
}

/// Distance to the walls of the box [low, high] from a point inside, and the axis that is hit.
double leave_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                 const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, int& axis) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (direction(i) == 0.0) continue;
    const double distance = ((direction(i) > 0.0 ? high(i) : low(i)) - origin(i)) / direction(i);
    if (distance < nearest) {
      nearest = distance;
      axis = i;
    }
  }
  return nearest;
}

}  // namespace

RayHit cast_ray(const CorridorShape& c, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction) {
  int axis = 0;
  const Eigen::Vector3d low(c.begin, -c.width / 2.0, 0.0);
  const Eigen::Vector3d high(c.end, c.width / 2.0, c.height);
  double distance = leave_box(low, high, origin, direction, axis);
  const Eigen::Vector3d hit = origin + distance * direction;
  if (axis == 1 && direction.y() > 0.0 && c.door_spacing > 0.0 && hit.z() < c.door_height) {
    const double center = std::round(hit.x() / c.door_spacing) * c.door_spacing;
    if (center >= c.first_door && std::abs(hit.x() - center) < c.door_width / 2.0) {
      const Eigen::Vector3d recess_low(center - c.door_width / 2.0, high.y() - 1.0, 0.0);
      const Eigen::Vector3d recess_high(center + c.door_width / 2.0, high.y() + c.recess_depth,
                                        c.door_height);
      distance += leave_box(recess_low, recess_high, hit, direction, axis);
    }
  }
  if (axis == 0 && c.open_ends && (hit.x() <= c.begin + 1e-6 || hit.x() >= c.end - 1e-6)) return {};
  return {distance, std::abs(direction(axis))};
}

KinematicWorld::KinematicWorld(const KinematicConfig& config)
    : config_(config),
      imu_random_(config.seed, "kinematic.imu"),
      leg_random_(config.seed, "kinematic.leg"),
      loss_random_(config.seed, "kinematic.loss"),
      lidar_random_(config.seed, "kinematic.lidar") {
  rig_.T_body_lidar = {so3_exp({0.0, 0.02, 0.0}), {-0.15, 0.0, 0.15}};
  rig_.T_body_base = {Eigen::Quaterniond::Identity(), {0.05, 0.0, -0.02}};
  walk_time_ = config.walk.distance / config.walk.speed + kRamp;
  leg_end_ = config.walk.stand + walk_time_;
  back_start_ = leg_end_ + 1.0 + kTurn;
  duration_ = config.walk.there_and_back ? back_start_ + walk_time_ + 1.0 : leg_end_ + 1.0;
  duration_ = std::ceil(duration_ * 10.0) / 10.0;  // whole scans
  RandomStream bias(config.seed, "kinematic.bias");
  gyro_bias_ = config.sensors.gyro_bias * bias.normal3();
  force_bias_ = config.sensors.force_bias * bias.normal3();
  T_odom_base_ = pose(0.0) * rig_.T_body_base;
}

Pose KinematicWorld::pose(double t) const {
  const WalkPlan& walk = config_.walk;
  const double out = t - walk.stand;
  const double back = t - back_start_;
  double x = progress(out, walk_time_, walk.speed);
  double swing = effort(out, walk_time_);
  double yaw = 0.0;
  if (walk.there_and_back) {
    const double turn = (t - leg_end_ - 0.5) / kTurn;
    x -= progress(back, walk_time_, walk.speed);
    yaw = kPi * ease(turn);
    swing += effort(back, walk_time_) + std::sin(kPi * std::clamp(turn, 0.0, 1.0));
  }
  const double phase = 2.0 * kPi * kStride * t;
  swing *= walk.bob;
  const Eigen::Vector3d angles(0.035 * std::sin(phase), 0.025 * std::sin(2.0 * phase + 1.0),
                               0.02 * std::sin(phase + 0.5));
  const Eigen::Vector3d shift(0.003 * std::sin(2.0 * phase + 2.0), 0.01 * std::sin(phase + 0.3),
                              0.008 * std::sin(2.0 * phase));
  return {yaw_rotation(yaw) * so3_exp(swing * angles),
          Eigen::Vector3d(x, 0.0, kBodyHeight) + swing * shift};
}

Pose KinematicWorld::T_world_body(Time stamp) const { return pose(to_seconds(stamp)); }

Eigen::Vector3d KinematicWorld::velocity(double t) const {
  constexpr double kStep = 1e-4;
  return (pose(t + kStep).translation - pose(t - kStep).translation) / (2.0 * kStep);
}

Eigen::Vector3d KinematicWorld::angular_velocity(double t) const {
  constexpr double kStep = 1e-4;
  return so3_log(pose(t - kStep).rotation.conjugate() * pose(t + kStep).rotation) / (2.0 * kStep);
}

ImuSample KinematicWorld::imu(Time stamp) {
  constexpr int kSteps = 20;
  const double dt = to_seconds(kImuPeriod) / kSteps;
  ImuSample sample;
  sample.stamp = stamp;
  for (int i = 0; i < kSteps; ++i) {
    const double begin = to_seconds(stamp - kImuPeriod) + i * dt;
    const double middle = begin + 0.5 * dt;
    const Eigen::Vector3d acceleration = (velocity(begin + dt) - velocity(begin)) / dt;
    sample.specific_force += pose(middle).rotation.conjugate() *
                             (acceleration + Eigen::Vector3d(0.0, 0.0, kGravity)) / kSteps;
    sample.angular_velocity += angular_velocity(middle) / kSteps;
  }
  sample.specific_force += force_bias_ + config_.sensors.force_noise * imu_random_.normal3();
  sample.angular_velocity += gyro_bias_ + config_.sensors.gyro_noise * imu_random_.normal3();
  return sample;
}

LegOdometrySample KinematicWorld::legs(Time stamp) {
  constexpr double kForget = 0.975;  // over 5 ms: a correlation time of 0.2 s
  const double t = to_seconds(stamp);
  const Pose body = pose(t);
  const Eigen::Vector3d rate = angular_velocity(t);
  const Eigen::Vector3d in_body =
      body.rotation.conjugate() * velocity(t) + rate.cross(rig_.T_body_base.translation);
  slow_noise_ = kForget * slow_noise_ + std::sqrt(1.0 - kForget * kForget) *
                                            config_.sensors.leg_slow_noise * leg_random_.normal3();
  LegOdometrySample sample;
  sample.stamp = stamp;
  const double standing = velocity(t).norm() < 1e-3 && rate.norm() < 1e-3 ? 0.0 : 1.0;
  sample.linear_velocity =
      (1.0 - config_.sensors.leg_scale_error) * in_body +
      standing * (slow_noise_ + config_.sensors.leg_noise * leg_random_.normal3());
  sample.angular_velocity = rate + gyro_bias_;
  const double dt = to_seconds(kLegPeriod);
  T_odom_base_ =
      T_odom_base_ * Pose{so3_exp(sample.angular_velocity * dt), sample.linear_velocity * dt};
  sample.T_odom_base = T_odom_base_;
  sample.contact = {true, false, false, true};
  return sample;
}

LidarScanPtr KinematicWorld::scan(Time end) {
  constexpr int kRings = 16;
  auto scan = std::make_shared<LidarScan>();
  scan->stamp = end - kScan;
  scan->end = end;
  const int columns = config_.sensors.lidar_columns;
  scan->points.reserve(static_cast<std::size_t>(columns * kRings));
  for (int column = 0; column < columns; ++column) {
    const auto offset = static_cast<std::int32_t>(kScan * column / columns);
    const Pose T_world_lidar = pose(to_seconds(scan->stamp + offset)) * rig_.T_body_lidar;
    const Eigen::Matrix3d R = T_world_lidar.R();
    const double azimuth = 2.0 * kPi * column / columns;
    for (int ring = 0; ring < kRings; ++ring) {
      const double elevation = (2.0 * ring - 15.0) * kPi / 180.0;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const RayHit hit = cast_ray(config_.corridor, T_world_lidar.translation, R * direction);
      const double range = hit.distance + config_.sensors.lidar_noise * lidar_random_.normal();
      if (hit.distance < 0.0 || range > config_.sensors.lidar_range) continue;
      if (hit.grazing_sine < config_.sensors.lidar_grazing_sine) continue;
      scan->points.push_back(
          {(range * direction).cast<float>(), 0.5F, offset, static_cast<std::uint16_t>(ring)});
    }
  }
  return scan;
}

bool KinematicWorld::advance(Duration span, std::vector<Delivery>& deliveries) {
  const Time until = std::min(now_ + span, duration());
  for (now_ += kLegPeriod; now_ <= until; now_ += kLegPeriod) {
    const LegOdometrySample sample = legs(now_);
    if (!loss_random_.chance(config_.sensors.leg_loss)) deliveries.push_back({now_, sample});
    if (now_ % kImuPeriod == 0) deliveries.push_back({now_, imu(now_)});
    if (now_ % kScan == 0) deliveries.push_back({now_, scan(now_)});
  }
  now_ -= kLegPeriod;
  return now_ < duration();
}

KinematicConfig short_walk() {
  KinematicConfig config;
  config.walk.distance = 2.5;
  config.corridor.end = 20.0;
  config.sensors.lidar_columns = 450;
  return config;
}

std::vector<Delivery> record(KinematicWorld& world) {
  std::vector<Delivery> deliveries;
  world.advance(world.duration(), deliveries);
  return deliveries;
}

Pose T_world_odom(const Trajectory& estimate, const KinematicWorld& world) {
  const StampedPose& first = estimate.front();
  return world.T_world_body(first.stamp) * first.pose.inverse();
}

double largest_error(const Trajectory& estimate, const KinematicWorld& world) {
  const Pose aligned = T_world_odom(estimate, world);
  double largest = 0.0;
  for (const StampedPose& each : estimate) {
    const Pose error = world.T_world_body(each.stamp).inverse() * aligned * each.pose;
    if (!error.translation.allFinite()) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, error.translation.norm());
  }
  return largest;
}

}  // namespace aims::test
