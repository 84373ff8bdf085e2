// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/feet.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace aims {
namespace {

/// Intervals over which angles are differenced: in shorter ones the resolution of the encoders
/// decides, longer ones without a packet span the change from swing to stance.
constexpr Duration kShortestInterval = 4 * kMillisecond;
constexpr Duration kLongestInterval = 30 * kMillisecond;

/// Angles that stay the same for longer are those of a robot that stands.
constexpr Duration kLongestRepeat = 100 * kMillisecond;

/// Error of the velocity from one standing foot, per axis [m/s].
constexpr double kFootSigma = 0.15;

/// Difference from the prediction that quarters the weight of a foot [m/s].
constexpr double kAgreement = 0.3;

/// Time over which a standing foot keeps the error of its velocity [s].
constexpr double kCorrelationTime = 0.02;

/// Weight of a foot without detected contact.
constexpr double kWithoutContact = 0.1;

/// With a smaller sum of weights no foot stands.
constexpr double kLeastWeight = 1e-3;

/// Backward motion of a foot counts so much of forward motion.
constexpr double kBackward = 2.0 / 3.0;
/// Below this speed a robot has no direction of walking [m/s].
constexpr double kWalking = 0.2;

/// |y|^2 with the part of y counted less by which the foot moves backward.
double misfit(const Eigen::Vector3d& innovation, const Eigen::Vector3d& predicted) {
  const Eigen::Vector3d ahead = predicted / std::max(predicted.norm(), kWalking);
  const double backward = std::min(innovation.dot(ahead), 0.0);
  return innovation.squaredNorm() - (1.0 - kBackward * kBackward) * backward * backward;
}

}  // namespace

void describe(Fields& f, FeetConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "fuse each foot by leg kinematics where samples have joint angles",
          "docs/decisions.md#each-foot-is-a-measurement"});
}

bool JointDifference::is_repeat(const JointPacket& reading) {
  if (reading.angle != angle_) {
    angle_ = reading.angle;
    changed_ = reading.stamp;
  }
  const Duration unchanged = reading.stamp - changed_;
  return unchanged > 0 && unchanged <= kLongestRepeat;
}

std::optional<JointState> JointDifference::update(const JointPacket& reading) {
  const Duration silent = reading.stamp - std::exchange(last_, reading.stamp);
  if (silent > kLongestInterval) past_.clear();
  if (is_repeat(reading)) {
    ++repeats_;
    return std::nullopt;
  }
  const auto since = [&](const JointPacket& each) { return reading.stamp - each.stamp; };
  while (!past_.empty() && since(past_.front()) > kLongestRepeat) past_.pop_front();
  while (past_.size() > 1 && since(past_[1]) >= kShortestInterval) past_.pop_front();
  std::optional<JointState> state;
  if (!past_.empty() && since(past_.front()) >= kShortestInterval) {
    const JointPacket& before = past_.front();
    const double step = to_seconds(since(before));
    state = {0.5 * (reading.angle + before.angle),
             (reading.angle - before.angle) / step,
             (reading.yield - before.yield) / step,
             (reading.load - before.load) / step,
             0.5 * step,
             repeats_};
  }
  repeats_ = 0;
  past_.push_back(reading);
  return state;
}

FootVelocities velocities_from_feet(const JointState& joints, double compliance,
                                    const Eigen::Vector3d& turning, const Eigen::Vector3d& up,
                                    const LegGeometry& geometry) {
  const JointVector rate = joints.rate + compliance * joints.yield_rate;
  FootVelocities velocities;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const LegMotion motion{joints_of(joints.angle, leg), joints_of(rate, leg), turning};
    velocities[static_cast<std::size_t>(leg)] =
        velocity_from_rolling_foot(leg, motion, up, geometry);
  }
  return velocities;
}

FootWeights weights_of_feet(const FootVelocities& feet, const std::array<bool, kLegCount>& contact,
                            const Eigen::Vector3d& predicted, double variance) {
  const double limit = kAgreement * kAgreement + 2.0 * variance;
  FootWeights weights{};
  for (std::size_t leg = 0; leg < feet.size(); ++leg) {
    const double root = 1.0 / (1.0 + misfit(predicted - feet[leg], predicted) / limit);
    weights[leg] = root * root * (contact[leg] ? 1.0 : kWithoutContact);
  }
  return weights;
}

double total_weight(const FootWeights& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  return sum >= kLeastWeight ? sum : 0.0;  // not a number: 0
}

Eigen::Vector3d mean_of_feet(const FootVelocities& feet, const FootWeights& weights) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t leg = 0; leg < feet.size(); ++leg) sum += weights[leg] * feet[leg];
  return sum / total_weight(weights);
}

double variance_of_feet(double weight, double rate_hz) {
  const double shared = std::max(1.0, 2.0 * kCorrelationTime * rate_hz);
  return shared * kFootSigma * kFootSigma / weight;
}

}  // namespace aims
