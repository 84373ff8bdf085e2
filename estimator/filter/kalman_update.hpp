// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "estimator/filter/error_state.hpp"

namespace aims {

/// Gaussian belief: nominal state and covariance of its error.
struct Belief {
  NominalState state;
  ErrorMatrix covariance = ErrorMatrix::Identity();  ///< that the gains follow from
  /// What the covariance of the error is beyond `covariance`, where a measurement counted for more
  /// than it states (`PoseMeasurement::stated`); none: nothing. It changes no gain.
  std::optional<ErrorMatrix> excess = std::nullopt;
};

/// The covariance of the error that the belief states.
ErrorMatrix stated_covariance(const Belief& belief);

/// A linearized measurement of three rows: residual(x [+] d) ~ residual + jacobian d, zero at the
/// truth up to `noise`.
struct LinearMeasurement {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Matrix3xError jacobian = Matrix3xError::Zero();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Identity();  ///< covariance
};

/// A measurement linearized at `from`, for the nearby state `to`: its residual there, with the same
/// Jacobian.
LinearMeasurement moved_to(const LinearMeasurement& measurement, const NominalState& from,
                           const NominalState& to);

/// Any number of linearized rows r + h y of six numbers y = jacobian d, such as the error of the
/// pose, in information form: the sums h^T R^-1 h and h^T R^-1 r.
struct PoseMeasurement {
  Matrix6 matrix = Matrix6::Zero();
  Vector6 vector = Vector6::Zero();
  Matrix6xError jacobian = Matrix6xError::Identity();  ///< rotation and position come first
  /// The information that it states, where `matrix`, from which the gain follows, is more.
  std::optional<Matrix6> stated = std::nullopt;
};

/// Which states a measurement corrects (Schmidt-Kalman update): the gain K becomes matrix() K. A
/// state that is not corrected keeps its value and its variance.
struct GainMask {
  bool legs = true;       ///< scale and bias of the legs
  bool gyro_bias = true;  ///< bias of the gyro
  /// Factor of the attitude, body axes.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  /// Factors of position and velocity, odometry axes.
  Eigen::Matrix3d translation = Eigen::Matrix3d::Identity();
  bool height = true;  ///< z of the position
  /// Factor of the bias of the accelerometer, body axes.
  Eigen::Matrix3d accelerometer_bias = Eigen::Matrix3d::Identity();

  ErrorMatrix matrix() const;

  /// matrix() * gain.
  template <int columns>
  Eigen::Matrix<double, ErrorState::kSize, columns> operator*(
      Eigen::Matrix<double, ErrorState::kSize, columns> gain) const {
    using E = ErrorState;
    auto rotation_rows = gain.template middleRows<3>(E::kRotation.offset);
    auto position_rows = gain.template middleRows<3>(E::kPosition.offset);
    auto velocity_rows = gain.template middleRows<3>(E::kVelocity.offset);
    auto bias_rows = gain.template middleRows<3>(E::kAccelerometerBias.offset);
    rotation_rows = rotation.lazyProduct(rotation_rows).eval();
    position_rows = translation.lazyProduct(position_rows).eval();
    velocity_rows = translation.lazyProduct(velocity_rows).eval();
    bias_rows = accelerometer_bias.lazyProduct(bias_rows).eval();
    if (!height) position_rows.row(2).setZero();
    if (!gyro_bias) gain.template middleRows<3>(E::kGyroBias.offset).setZero();
    if (!legs) gain.template middleRows<E::kLegSize>(E::kLegScale.offset).setZero();
    return gain;
  }

  bool operator==(const GainMask&) const = default;
};

/// The belief after fusing `measurement`, linearized at the belief.
Belief fuse(const Belief& prior, const LinearMeasurement& measurement, const GainMask& mask = {});

/// The belief after fusing `measurement` with the gain conditioned on known leg scale and bias
/// (Schmidt-Kalman; docs/estimators.md#cross-validated-information): leg scale and bias are not
/// corrected, and correlations with them do not enter the gain. The covariance is that of this
/// gain.
Belief fuse_given_legs(const Belief& prior, const LinearMeasurement& measurement,
                       const GainMask& mask = {});

/// One step of the iterated update: the belief after fusing `measurement`, linearized at
/// `linearization`, with `prior`. With linearization == prior.state it is the standard update. What
/// it states (stated_covariance) is about the returned state.
Belief fuse(const Belief& prior, const NominalState& linearization,
            const PoseMeasurement& measurement, const GainMask& mask = {});

/// What a measurement holds at one linearization.
struct Linearization {
  PoseMeasurement measurement;
  GainMask mask;
};

/// How far a step of the iterated update went.
enum class Step {
  kConverged,  ///< no further step is needed
  kSmall,
  kLarge,  ///< beyond where its linearization holds: never the last
};

/// Bound on the steps of an iterated update, for those that stay large.
inline constexpr int kMaxSteps = 20;

/// How an iterated update ended.
struct IteratedUpdate {
  Belief belief;           ///< the prior when the measurement was refused
  int iterations = 0;      ///< steps taken
  bool converged = false;  ///< the last step was kConverged
  bool refused = false;    ///< a linearization gave no measurement
};

/// The iterated update: up to `max_iterations` steps, more while they are large, the first
/// linearized at `start`, each other at the result of the last. `linearize(state)` returns the
/// measurement there (std::optional<Linearization>), empty to refuse it: then the prior stays.
/// `step_of(before, after)` returns the Step between two states, and `fuse_at(prior, state, at)`
/// the belief after one step with that Linearization.
template <class Linearize, class StepOf, class FuseAt>
IteratedUpdate iterated_update(const Belief& prior, const NominalState& start, int max_iterations,
                               Linearize&& linearize, StepOf&& step_of, FuseAt&& fuse_at) {
  IteratedUpdate update{prior};
  const auto goes_on = [&](Step last) {
    if (last == Step::kLarge) return update.iterations < kMaxSteps;
    return last == Step::kSmall && update.iterations < max_iterations;
  };
  Step last = Step::kSmall;
  while (goes_on(last)) {
    const NominalState before = update.iterations == 0 ? start : update.belief.state;
    const std::optional<Linearization> at = linearize(before);
    if (!at) return {prior, update.iterations, false, true};
    update.belief = fuse_at(prior, before, *at);
    ++update.iterations;
    last = step_of(before, update.belief.state);
  }
  update.converged = last == Step::kConverged;
  return update;
}

/// The same with fuse().
template <class Linearize, class StepOf>
IteratedUpdate iterated_update(const Belief& prior, const NominalState& start, int max_iterations,
                               Linearize&& linearize, StepOf&& step_of) {
  const auto fuse_at = [](const Belief& belief, const NominalState& state,
                          const Linearization& at) {
    return fuse(belief, state, at.measurement, at.mask);
  };
  return iterated_update(prior, start, max_iterations, linearize, step_of, fuse_at);
}

}  // namespace aims
