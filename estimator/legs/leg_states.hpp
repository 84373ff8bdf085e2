// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Scale and bias of the leg odometry as filter states.
struct LegStatesConfig {
  bool scale = false;         ///< estimate a scale per axis
  bool bias = false;          ///< estimate a bias per axis
  double scale_sigma = 0.12;  ///< initial [-]
  double scale_walk = 1e-3;   ///< [1/sqrt(s)]
  double bias_sigma = 0.01;   ///< initial [m/s]
  double bias_walk = 1e-4;    ///< [m/s/sqrt(s)]
};

void describe(Fields& fields, LegStatesConfig& config);

/// The belief with the initial variances of the enabled leg states.
Belief open_leg_states(Belief belief, const LegStatesConfig& config);

/// Adds the random walk of the enabled leg states over `dt` [s].
void walk_leg_states(Belief& belief, const LegStatesConfig& config, double dt);

/// First-order low pass of the velocity from leg odometry, with the time constant of a stride.
class StrideMean {
 public:
  /// Adds a sample and returns the mean, base axes [m/s].
  const Eigen::Vector3d& update(const LegOdometrySample& sample);

 private:
  std::optional<Time> stamp_;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
};

}  // namespace aims
