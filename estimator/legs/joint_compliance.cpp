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

/// How far the weight compresses a rubber foot, and its deviation [m]: feet of 10 to 50 kN/m under
/// 12 kg.
constexpr double kRubber = 5e-3;
constexpr double kRubberSigma = 4e-3;

/// Before, the part of the way that joints take is not known: a standing robot sways [m].
constexpr double kShortestWay = 1.0;

/// Softer joints do not carry a robot [rad/m].
constexpr double kLargestCompliance = 3.0;

double gain_of(double time, double rate_hz) { return 1.0 - std::exp(-1.0 / (time * rate_hz)); }

}  // namespace

JointVector yield_of_joints(const JointVector& angle, const LoadShares& shares,
                            const Eigen::Vector3d& up, const LegGeometry& geometry) {
  JointVector yield;
  for (int leg = 0; leg < kLegCount; ++leg) {
    yield.segment<3>(3 * leg) =
        shares(leg) * foot_jacobian(leg, joints_of(angle, leg), geometry).transpose() * up;
  }
  return yield;
}

LoadShares JointCompliance::shares(const LegOdometrySample& sample, double rate_hz) {
  LoadShares loads = LoadShares::Zero();
  if (!sample.contact_force) return loads;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const double load = (*sample.contact_force)[static_cast<std::size_t>(leg)];
    loads(leg) = std::isfinite(load) ? std::max(load, 0.0) : 0.0;
  }
  const double sum = loads.sum();
  mean_load_ =
      mean_load_ == 0.0 ? sum : mean_load_ + gain_of(kLoadTime, rate_hz) * (sum - mean_load_);
  return mean_load_ > 0.0 ? LoadShares(loads / mean_load_) : LoadShares::Zero();
}

bool JointCompliance::learns() const { return walked_ < kLearningTime; }

bool JointCompliance::is_learned() const { return known_variance_ || !learns(); }

void JointCompliance::update(const Drift& drift, double rate_hz) {
  if (!learns()) return;
  walked_ = std::min(walked_ + 1.0 / rate_hz, kLearningTime);
  const double gain = 1.0 / (walked_ * rate_hz);
  mean_.climb += gain * (drift.climb - mean_.climb);
  mean_.joints += gain * (drift.joints - mean_.joints);
  mean_.rubber += gain * (drift.rubber - mean_.rubber);
  mean_.along += gain * (drift.along - mean_.along);
  mean_.speed += gain * (drift.speed - mean_.speed);
  judge_known();
  if (known_variance_) return;
  const double response = kSigma * kSigma * mean_.joints;
  const double beyond_prior = beyond_rubber() + mean_.joints * kPrior;
  value_ = std::clamp(kPrior - response * beyond_prior / (response * mean_.joints + variance()),
                      0.0, kLargestCompliance);
}

double JointCompliance::part_of_way() const {
  if (mean_.speed * walked_ < kShortestWay) return 0.0;
  return std::max(0.0, value_ * mean_.along / mean_.speed);
}

/// The mean climb that rubber of the usual stiffness does not explain [m/s].
double JointCompliance::beyond_rubber() const { return mean_.climb + mean_.rubber * kRubber; }

/// Of that climb, by legs of rigid joints [m^2/s^2].
double JointCompliance::variance() const {
  const double rubber = mean_.rubber * kRubberSigma;
  return kClimbSigma * kClimbSigma * kLearningTime / walked_ + rubber * rubber;
}

void JointCompliance::know(double value, double sigma) {
  value_ = std::clamp(value, 0.0, kLargestCompliance);
  known_variance_ = sigma * sigma;
}

/// At the end of learning: the value by the drift alone against the one that is known.
void JointCompliance::judge_known() {
  if (!known_variance_ || learns() || information() == 0.0) return;
  const double difference = information_vector() / information() - value_;
  contradicted_ =
      difference * difference > kChiSquare9999[0] * (1.0 / information() + *known_variance_);
  if (contradicted_) known_variance_.reset();
}

double JointCompliance::information() const {
  return walked_ > 0.0 ? mean_.joints * mean_.joints / variance() : 0.0;
}

double JointCompliance::information_vector() const {
  if (mean_.joints == 0.0) return 0.0;
  return information() * std::clamp(-beyond_rubber() / mean_.joints, 0.0, kLargestCompliance);
}

}  // namespace aims
