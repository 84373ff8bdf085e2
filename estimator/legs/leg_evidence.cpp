// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

double squared(double x) { return x * x; }

}  // namespace

StanceEvidence compare_feet(const LegOdometrySample& sample,
                            const Eigen::Vector3d& angular_velocity, const LegGeometry& geometry) {
  StanceEvidence evidence;
  const Eigen::Map<const JointVector> position(sample.joint_position.data());
  const Eigen::Map<const JointVector> rate(sample.joint_velocity.data());
  evidence.told = position.allFinite() && rate.allFinite() && !position.isZero(0.0);
  if (!evidence.told) return evidence;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (!sample.contact[leg]) continue;
    const LegMotion motion{joints_of(position, leg), joints_of(rate, leg), angular_velocity};
    const Eigen::Vector3d velocity = velocity_from_foot(leg, motion, geometry);
    sum += velocity;
    squares += velocity.cwiseAbs2();
    ++evidence.standing;
  }
  const double n = evidence.standing;
  if (n < 2) return evidence;
  const Eigen::Array3d variance = (squares - sum.cwiseAbs2() / n) / (n - 1.0);
  evidence.spread = variance.max(0.0).sqrt();
  return evidence;
}

Eigen::Matrix3d evident_variance(const LegEvidenceConfig& config, const StanceEvidence& stance,
                                 const LegCircumstances& circumstances) {
  Eigen::Array3d variance = config.velocity_sigma.cwiseAbs2();
  if (stance.told) {
    variance += (stance.spread.array().square() - squared(config.nominal_spread)).max(0.0);
    if (stance.standing == 1) variance += squared(config.one_foot_sigma);
    if (stance.standing == 0) variance += squared(config.no_foot_sigma);
  }
  variance += squared(config.turning_arm * circumstances.yaw_rate);
  variance += squared(std::min(config.gap_growth * circumstances.gap, config.no_foot_sigma));
  return variance.matrix().asDiagonal();
}

std::optional<double> gate_inflation(const LegEvidenceConfig& config, double distance) {
  const double factor = distance / config.gate;
  if (!(factor <= config.drop)) return std::nullopt;
  return std::max(1.0, factor);
}

LegEvidence::LegEvidence(const LegEvidenceConfig& config, const LegConfig& leg)
    : config_(config),
      period_(1.0 / leg.rate_hz),
      repeats_(std::max(1.0, 2.0 * config.correlation_time * leg.rate_hz)) {}

Eigen::Matrix3d LegEvidence::noise(const LegOdometrySample& sample,
                                   const Eigen::Vector3d& angular_velocity) {
  LegCircumstances circumstances;
  circumstances.yaw_rate = angular_velocity.z();
  if (last_) {
    circumstances.gap = std::max(0.0, to_seconds(sample.stamp - *last_) - 1.5 * period_);
  }
  last_ = sample.stamp;
  return repeats_ *
         evident_variance(config_, compare_feet(sample, angular_velocity), circumstances);
}

std::optional<double> LegEvidence::inflation(const LinearMeasurement& measurement,
                                             const ErrorMatrix& covariance) {
  // One sample by itself is as good as its own variance, without what its neighbours repeat. That
  // the legs' scale is unknown excuses no slip: a wrong scale lasts, and passes for that.
  Matrix3xError jacobian = measurement.jacobian;
  columns(jacobian, ErrorState::kLegScale).setZero();
  columns(jacobian, ErrorState::kLegBias).setZero();
  const Eigen::Matrix3d expected =
      jacobian * covariance * jacobian.transpose() + measurement.noise / repeats_;
  const double distance = measurement.residual.dot(expected.llt().solve(measurement.residual));
  if (distance <= config_.gate || !last_) {
    outside_since_.reset();
    return 1.0;
  }
  if (!outside_since_) outside_since_ = last_;
  if (*last_ - *outside_since_ > from_seconds(config_.longest_slip)) return 1.0;
  return gate_inflation(config_, distance);
}

}  // namespace aims
