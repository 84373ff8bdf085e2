// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/outage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aims {
namespace {

constexpr double kWalkingTime = 3.0;   ///< after which a robot has forgotten its velocity [s]
constexpr double kWalkingSpeed = 0.7;  ///< [m/s]
constexpr double kTurnRate = 1.5;      ///< the largest of a robot that turns in place [rad/s]
constexpr double kTilt = 0.1;          ///< of the trunk in a trot [rad]

double squared(double value) { return value * value; }

}  // namespace

bool is_outage(const InertialSegment& segment) {
  return !segment.measured && to_seconds(segment.end - segment.begin) > kLongestBridge;
}

NominalState turned(const NominalState& state, double angle) {
  const Eigen::Quaterniond turn = yaw_rotation(angle);
  NominalState result = state;
  result.rotation = turn * state.rotation;
  result.velocity = turn * state.velocity;
  return result;
}

double heading_reach(double duration) { return std::min(kTurnRate * duration, std::numbers::pi); }

Belief with_unmeasured_heading(const Belief& belief, double before, double duration) {
  const double added =
      squared(0.5 * heading_reach(duration)) - squared(0.5 * heading_reach(before));
  // Errors of the rotation are in body axes.
  const Eigen::Vector3d up = belief.state.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  Belief widened = belief;
  block(widened.covariance, ErrorState::kRotation, ErrorState::kRotation) +=
      added * up * up.transpose();
  return widened;
}

Belief after_outage(const Belief& belief, double duration) {
  using E = ErrorState;
  const double kept = std::exp(-duration / kWalkingTime);
  const double walked = kWalkingTime * (1.0 - kept);
  Belief after = belief;
  after.state.position += walked * belief.state.velocity;
  after.state.velocity *= kept;
  ErrorMatrix F = ErrorMatrix::Identity();
  block(F, E::kPosition, E::kVelocity).diagonal().setConstant(walked);
  block(F, E::kVelocity, E::kVelocity).diagonal().setConstant(kept);
  after.covariance = F * belief.covariance * F.transpose();
  if (belief.excess) after.excess = F * *belief.excess * F.transpose();
  const auto widen = [&](E::Block at, double sigma) {
    after.covariance.diagonal().segment<3>(at.offset).array() += squared(sigma);
  };
  widen(E::kRotation, kTilt);
  widen(E::kVelocity, std::sqrt(1.0 - kept * kept) * kWalkingSpeed);
  // Three deviations reach a robot that turned around at once.
  widen(E::kPosition, 2.0 / 3.0 * kWalkingSpeed * duration);
  return after;
}

}  // namespace aims
