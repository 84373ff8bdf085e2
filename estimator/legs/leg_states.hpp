// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/measurements.hpp"
#include "estimator/aims/directional_config.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// The belief with the states of the legs (scale and bias) open, as far as they are switched on.
Belief open_leg_states(Belief belief, const LegStatesConfig& config);

/// The belief after the states of the legs have walked for `dt` [s].
void walk_leg_states(Belief& belief, const LegStatesConfig& config, double dt);

/// Mean of the velocity that the legs report over about a stride: a first-order low pass.
class StrideMean {
 public:
  /// Takes a sample and returns the mean, base axes [m/s].
  const Eigen::Vector3d& update(const LegOdometrySample& sample);

  /// The mean so far, base axes [m/s].
  const Eigen::Vector3d& value() const { return mean_; }

 private:
  std::optional<Time> stamp_;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
};

}  // namespace aims
