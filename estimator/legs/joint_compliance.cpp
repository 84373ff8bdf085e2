// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/joint_compliance.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/filter/entry_information.hpp"

namespace aims {
namespace {

/// Time over which the load is averaged [s]: several strides.
constexpr double kLoadTime = 2.0;
/// Time of walking over which the compliance is learned [s]. It is a property of the robot; later,
/// without LiDAR, drift of pitch and speed would pass for it.
constexpr double kLearningTime = 20.0;

/// Deviation of the mean vertical velocity by rigid legs [m/s].
constexpr double kClimbSigma = 0.01;

/// Softer joints do not carry a robot [rad/m].
constexpr double kLargestCompliance = 3.0;

double gain_of(double time, double rate_hz) { return 1.0 - std::exp(-1.0 / (time * rate_hz)); }

}  // namespace

JointVector JointCompliance::yield(const LegOdometrySample& sample, const Eigen::Vector3d& up,
                                   const LegGeometry& geometry, double rate_hz) {
  JointVector yield = JointVector::Zero();
  if (!sample.contact_force) return yield;
  FootLoads loads = *sample.contact_force;
  double sum = 0.0;
  for (double& load : loads) {
    load = std::isfinite(load) ? std::max(load, 0.0) : 0.0;
    sum += load;
  }
  mean_load_ =
      mean_load_ == 0.0 ? sum : mean_load_ + gain_of(kLoadTime, rate_hz) * (sum - mean_load_);
  if (!(mean_load_ > 0.0)) return yield;
  const Eigen::Map<const JointVector> angle(sample.joint_position.data());
  for (int leg = 0; leg < kLegCount; ++leg) {
    const double share = loads[static_cast<std::size_t>(leg)] / mean_load_;
    yield.segment<3>(3 * leg) =
        share * foot_jacobian(leg, joints_of(angle, leg), geometry).transpose() * up;
  }
  return yield;
}

bool JointCompliance::is_learned() const { return known_variance_ || walked_ >= kLearningTime; }

void JointCompliance::update(double climb, double change, double rate_hz) {
  if (walked_ >= kLearningTime) return;
  walked_ = std::min(walked_ + 1.0 / rate_hz, kLearningTime);
  const double gain = 1.0 / (walked_ * rate_hz);
  climb_ += gain * (climb - climb_);
  change_ += gain * (change - change_);
  judge_known();
  if (known_variance_) return;
  const double response = kSigma * kSigma * change_;
  const double noise = kClimbSigma * kClimbSigma * kLearningTime / walked_;
  const double beyond_prior = climb_ + change_ * kPrior;
  value_ = std::clamp(kPrior - response * beyond_prior / (response * change_ + noise), 0.0,
                      kLargestCompliance);
}

void JointCompliance::know(double value, double sigma) {
  value_ = std::clamp(value, 0.0, kLargestCompliance);
  known_variance_ = sigma * sigma;
}

/// At the end of learning: the value by the drift alone against the one that is known.
void JointCompliance::judge_known() {
  if (!known_variance_ || walked_ < kLearningTime || information() == 0.0) return;
  const double difference = information_vector() / information() - value_;
  contradicted_ = difference * difference > kChiSquare9999[0] * (1.0 / information() + *known_variance_);
  if (contradicted_) known_variance_.reset();
}

double JointCompliance::information() const {
  return change_ * change_ * walked_ / (kClimbSigma * kClimbSigma * kLearningTime);
}

double JointCompliance::information_vector() const {
  if (change_ == 0.0) return 0.0;
  return information() * std::clamp(-climb_ / change_, 0.0, kLargestCompliance);
}

}  // namespace aims
