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

double heading_reach(double outage) { return std::min(kTurnRate * outage, std::numbers::pi); }

Belief after_outage(const Belief& belief, double duration) {
  using E = ErrorState;
  const double kept = std::exp(-duration / kWalkingTime);
  const double walked = kWalkingTime * (1.0 - kept);
  Belief after = belief;
  after.state.position += walked * belief.state.velocity;
  after.state.velocity *= kept;
  ErrorMatrix F = ErrorMatrix::Identity();
  F.block<3, 3>(E::kPosition.offset, E::kVelocity.offset).diagonal().setConstant(walked);
  F.block<3, 3>(E::kVelocity.offset, E::kVelocity.offset).diagonal().setConstant(kept);
  after.covariance = F * belief.covariance * F.transpose();
  const auto widen = [&](ErrorState::Block at, const Eigen::Matrix3d& covariance) {
    after.covariance.block<3, 3>(at.offset, at.offset) += covariance;
  };
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  widen(E::kVelocity, (1.0 - kept * kept) * squared(kWalkingSpeed) * I);
  // Three deviations reach a robot that turned around at once.
  widen(E::kPosition, squared(2.0 / 3.0 * kWalkingSpeed * duration) * I);
  // Errors of the rotation are in body axes.
  const Eigen::Vector3d up = belief.state.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  widen(E::kRotation,
        squared(kTilt) * I + squared(0.5 * heading_reach(duration)) * up * up.transpose());
  return after;
}

}  // namespace aims
