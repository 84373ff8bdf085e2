// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/leg_states.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Time constant of the mean over a stride; strides of quadrupeds last half a second [s].
constexpr double kStride = 0.5;

void add_variance(ErrorMatrix& covariance, ErrorState::Block at, double sigma, double factor) {
  block(covariance, at, at).diagonal().array() += factor * sigma * sigma;
}

}  // namespace

Belief open_leg_states(Belief belief, const LegStatesConfig& config) {
  if (config.scale) {
    add_variance(belief.covariance, ErrorState::kLegScale, config.scale_sigma, 1.0);
  }
  if (config.bias) {
    add_variance(belief.covariance, ErrorState::kLegBias, config.bias_sigma, 1.0);
  }
  return belief;
}

void walk_leg_states(Belief& belief, const LegStatesConfig& config, double dt) {
  if (config.scale) add_variance(belief.covariance, ErrorState::kLegScale, config.scale_walk, dt);
  if (config.bias) add_variance(belief.covariance, ErrorState::kLegBias, config.bias_walk, dt);
}

const Eigen::Vector3d& StrideMean::update(const LegOdometrySample& sample) {
  const double dt = stamp_ ? std::max(to_seconds(sample.stamp - *stamp_), 0.0) : kStride;
  stamp_ = sample.stamp;
  mean_ += (1.0 - std::exp(-dt / kStride)) * (sample.linear_velocity - mean_);
  return mean_;
}

}  // namespace aims
