// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/motion.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace aims::independent {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSpeedRamp = 1.2;  ///< [s]
constexpr double kTurnRamp = 0.8;   ///< [s]
constexpr double kStep = 1e-3;      ///< of the differences [s]

// Amplitudes of the body's oscillation at full activity.
constexpr double kSurge = 0.004;         ///< [m]
constexpr double kSway = 0.006;          ///< [m]
constexpr double kBounce = 0.005;        ///< [m]
constexpr double kRoll = 0.021;          ///< [rad]
constexpr double kPitch = 0.018;         ///< [rad]
constexpr double kYaw = 0.012;           ///< [rad]
constexpr double kWander = 0.06;         ///< sideways, along the route [m]
constexpr double kWanderLength = 11.0;   ///< [m]
constexpr double kHeadingWander = 0.03;  ///< [rad]
constexpr double kHeadingLength = 7.3;   ///< [m]

/// Integral from 0 to u of the fifth-order smooth step, for u in [0, 1].
double smooth_step_integral(double u) { return u * u * u * u * (u * u - 3.0 * u + 2.5); }

double smooth_step(double u) { return u * u * u * (u * (6.0 * u - 15.0) + 10.0); }

Eigen::Quaterniond rotation_of(double yaw, double pitch, double roll) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

Eigen::Array4d random_phases(std::uint64_t seed) {
  RandomStream random = rng(seed, "independent.motion");
  Eigen::Array4d phases;
  for (double& phase : phases) phase = random.uniform(0.0, 2.0 * kPi);
  return phases;
}

}  // namespace

SmoothMove::SmoothMove(double length, double speed, double ramp)
    : speed_(speed), ramp_(ramp), cruise_(length / speed - ramp) {
  assert(cruise_ >= 0.0);
}

double SmoothMove::position(double t) const {
  if (t <= 0.0) return 0.0;
  if (t < ramp_) return speed_ * ramp_ * smooth_step_integral(t / ramp_);
  if (t <= ramp_ + cruise_) return speed_ * (t - 0.5 * ramp_);
  const double left = std::max(0.0, duration() - t);
  return speed_ * (cruise_ + ramp_) - speed_ * ramp_ * smooth_step_integral(left / ramp_);
}

double SmoothMove::rate(double t) const {
  const double edge = std::min(t, duration() - t);
  return speed_ * smooth_step(std::clamp(edge / ramp_, 0.0, 1.0));
}

Walk::Walk(const WalkOptions& options)
    : options_(options),
      leg_(options.length, options.speed, kSpeedRamp),
      turn_(kPi, options.turn_rate, kTurnRamp),
      turn_start_(options.stand_start + leg_.duration()),
      back_start_(turn_start_ + turn_.duration()),
      end_(back_start_ + leg_.duration()),
      phases_(random_phases(options.seed)) {}

double Walk::activity(double t) const {
  const double speed = leg_.rate(t - start()) + leg_.rate(t - back_start_);
  return speed / options_.speed + turn_.rate(t - turn_start_) / options_.turn_rate;
}

Pose Walk::pose(double t) const {
  const double out = leg_.position(t - start());
  const double back = leg_.position(t - back_start_);
  const double route = out + back;
  const double gait = activity(t);
  const double phase = 2.0 * kPi * strides(t);
  const auto wander = [route](double amplitude, double length, double offset) {
    return amplitude * (std::sin(2.0 * kPi * route / length + offset) - std::sin(offset));
  };
  const double heading = turn_.position(t - turn_start_) +
                         wander(kHeadingWander, kHeadingLength, phases_[0]) +
                         gait * kYaw * std::sin(phase + phases_[1]);
  const Eigen::Vector3d on_route(out - back, wander(kWander, kWanderLength, phases_[2]),
                                 kBodyHeight);
  const Eigen::Vector3d swing =
      gait * Eigen::Vector3d(kSurge * std::sin(2.0 * phase + phases_[3]),
                             kSway * std::sin(phase + 0.4), kBounce * std::sin(2.0 * phase));
  return {rotation_of(heading, gait * kPitch * std::sin(2.0 * phase + 0.9),
                      gait * kRoll * std::sin(phase - 0.6)),
          on_route + yaw_rotation(heading) * swing};
}

BodyState Walk::state(double t) const {
  const Pose before2 = pose(t - 2.0 * kStep);
  const Pose before = pose(t - kStep);
  const Pose now = pose(t);
  const Pose after = pose(t + kStep);
  const Pose after2 = pose(t + 2.0 * kStep);
  const Eigen::Vector3d acceleration =
      (16.0 * (after.translation + before.translation) - after2.translation - before2.translation -
       30.0 * now.translation) /
      (12.0 * kStep * kStep);
  const auto turned = [](const Pose& from, const Pose& to) {
    return so3_log(from.rotation.conjugate() * to.rotation);
  };
  BodyState state;
  state.T_world_body = now;
  state.velocity = (8.0 * (after.translation - before.translation) -
                    (after2.translation - before2.translation)) /
                   (12.0 * kStep);
  state.angular_velocity = (8.0 * turned(before, after) - turned(before2, after2)) / (12.0 * kStep);
  state.specific_force =
      now.rotation.conjugate() * (acceleration + kGravity * Eigen::Vector3d::UnitZ());
  return state;
}

}  // namespace aims::independent
