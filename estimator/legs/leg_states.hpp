// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/legs/leg_velocity_model.hpp"

namespace aims {

/// Random walks of the scale [1/sqrt(s)] and the bias [m/s/sqrt(s)].
inline constexpr double kLegScaleWalk = 1e-3;
inline constexpr double kLegBiasWalk = 1e-4;

/// Initial deviation of the bias [m/s]: the mean error along the way of a robot that does not slip.
inline constexpr double kLegBiasSigma = 0.01;

/// Deviation of the scale of legs that are measured foot by foot [-]
/// (docs/decisions.md#each-foot-is-a-measurement).
inline constexpr double kFeetScaleSigma = 0.04;

/// The same where joints take the fraction `part` of the way
/// (docs/decisions.md#soft-joints-make-the-scale-uncertain).
double feet_scale_sigma(double part);

/// Scale and bias of the leg odometry as filter states.
struct LegStatesConfig {
  bool enabled = false;       ///< estimate a scale and a bias per axis
  double scale_sigma = 0.12;  ///< initial [-]
};

void describe(Fields& fields, LegStatesConfig& config);

/// The belief with the initial variances of the leg states, where they are enabled.
Belief open_leg_states(Belief belief, const LegStatesConfig& config);

/// The part of the covariance of the position that the leg scale explains, odometry axes [m^2].
Eigen::Matrix3d position_covariance_by_leg_scale(const Belief& belief);

/// Adds the random walk of the enabled leg states over `dt` [s].
void walk_leg_states(Belief& belief, const LegStatesConfig& config, double dt);

/// Means of a velocity over strides: two first-order low passes in series, each
/// with the time constant T of a stride. They lag by T and 2 T.
class StrideMeans {
 public:
  /// Adds a `velocity` at `stamp`; it and the means, base axes [m/s].
  LegVelocity update(Time stamp, const Eigen::Vector3d& velocity);

 private:
  std::optional<Time> stamp_;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_of_mean_ = Eigen::Vector3d::Zero();
};

}  // namespace aims
