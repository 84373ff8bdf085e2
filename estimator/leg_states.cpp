// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/leg_states.hpp"

namespace aims {
namespace {

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

}  // namespace aims
