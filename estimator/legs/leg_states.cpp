// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_states.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Time constant of the mean over a stride; a stride of a quadruped lasts half a second [s].
constexpr double kStride = 0.5;

/// Joints that take less of the way are covered by kFeetScaleSigma [-]. Of what they take beyond,
/// each point adds two to the deviation: their load comes late and is held, and the way before they
/// are learned is not revised.
constexpr double kUsualPartOfWay = 0.08;
constexpr double kSigmaBeyond = 2.0;

void add_variance(ErrorMatrix& covariance, ErrorState::Block at, double sigma, double factor) {
  block(covariance, at, at).diagonal().array() += factor * sigma * sigma;
}

}  // namespace

void describe(Fields& f, LegStatesConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "estimate scale and bias of the leg odometry"});
  f.number("scale_sigma", c.scale_sigma,
           {"-", positive_up_to(1e6), "initial deviation of the scale; with feet at most 0.04",
            "docs/decisions.md#leg-scale-with-a-prior-of-012"});
}

Belief open_leg_states(Belief belief, const LegStatesConfig& config) {
  if (!config.enabled) return belief;
  add_variance(belief.covariance, ErrorState::kLegScale, config.scale_sigma, 1.0);
  add_variance(belief.covariance, ErrorState::kLegBias, kLegBiasSigma, 1.0);
  return belief;
}

double feet_scale_sigma(double part) {
  return kFeetScaleSigma + kSigmaBeyond * std::max(0.0, part - kUsualPartOfWay);
}

Eigen::Matrix3d position_covariance_by_leg_scale(const Belief& belief) {
  using E = ErrorState;
  const ErrorMatrix P = stated_covariance(belief);
  const Eigen::Matrix3d scale = block(P, E::kLegScale, E::kLegScale);
  const Eigen::Matrix3d shared = block(P, E::kPosition, E::kLegScale);
  return shared * scale.ldlt().solve(shared.transpose());
}

void walk_leg_states(Belief& belief, const LegStatesConfig& config, double dt) {
  if (!config.enabled) return;
  add_variance(belief.covariance, ErrorState::kLegScale, kLegScaleWalk, dt);
  add_variance(belief.covariance, ErrorState::kLegBias, kLegBiasWalk, dt);
}

LegVelocity StrideMeans::update(Time stamp, const Eigen::Vector3d& velocity) {
  const double dt = stamp_ ? std::max(to_seconds(stamp - *stamp_), 0.0) : kStride;
  const double gain = 1.0 - std::exp(-dt / kStride);
  stamp_ = stamp;
  mean_ += gain * (velocity - mean_);
  mean_of_mean_ += gain * (mean_ - mean_of_mean_);
  return {velocity, 2.0 * mean_ - mean_of_mean_, mean_of_mean_};
}

}  // namespace aims
