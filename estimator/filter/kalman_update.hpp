// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <optional>
#include <utility>

#include "estimator/filter/error_state.hpp"

namespace aims {

/// A filter state: the size of its error, `State::kErrorSize`, and beside it the functions
/// boxplus(state, delta), boxminus(state, origin), boxminus_jacobian(origin, delta) and
/// reset_jacobian(state, delta), as error_state.hpp has them for NominalState.
template <class State>
using ErrorVectorOf = Eigen::Matrix<double, State::kErrorSize, 1>;
template <class State>
using ErrorMatrixOf = Eigen::Matrix<double, State::kErrorSize, State::kErrorSize>;

/// Gaussian belief: nominal state and covariance of its error.
template <class State>
struct BeliefOf {
  State state;
  ErrorMatrixOf<State> covariance = ErrorMatrixOf<State>::Identity();
};

/// Measurements of any number of rows in information form: A = H^T R^-1 H, b = H^T R^-1 r.
template <class State>
struct InformationOf {
  ErrorMatrixOf<State> matrix = ErrorMatrixOf<State>::Zero();
  ErrorVectorOf<State> vector = ErrorVectorOf<State>::Zero();
};

using Belief = BeliefOf<NominalState>;
using Information = InformationOf<NominalState>;

/// A linearized measurement of three rows: residual(x [+] d) ~ residual + jacobian d, zero at the
/// truth up to `noise`.
struct LinearMeasurement {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Matrix3xError jacobian = Matrix3xError::Zero();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Identity();  ///< covariance
};

/// The gain mask that corrects every state.
inline ErrorMatrix correct_all() { return ErrorMatrix::Identity(); }

/// The belief after fusing `measurement`, in gain form, with the gain K replaced by `gain_mask` K
/// (Schmidt-Kalman update).
Belief fuse(const Belief& prior, const LinearMeasurement& measurement,
            const ErrorMatrix& gain_mask = correct_all());

/// The information of one three-row measurement.
Information information_of(const LinearMeasurement& measurement);

/// The information of rows that depend on the pose alone: 6x6 matrix and 6-vector.
Information pose_information(const Matrix6& matrix, const Vector6& vector);

/// Inverse of a covariance (symmetric, positive definite).
template <class Matrix>
Matrix inverse_spd(const Matrix& matrix) {
  const Matrix inverse = matrix.llt().solve(Matrix::Identity());
  return 0.5 * (inverse + inverse.transpose());
}

/// A prior about another state than its mean.
template <class State>
struct ShiftedPrior {
  ErrorVectorOf<State> offset;       ///< from the prior's mean
  ErrorVectorOf<State> pull;         ///< J^T P^-1 offset, with J of boxminus_jacobian()
  ErrorMatrixOf<State> information;  ///< J^T P^-1 J
};

/// The prior with the mean `prior` and the inverse covariance `prior_information`, about
/// `linearization`.
template <class State>
ShiftedPrior<State> shifted_prior(const State& prior, const ErrorMatrixOf<State>& prior_information,
                                  const State& linearization) {
  const ErrorVectorOf<State> offset = boxminus(linearization, prior);
  const ErrorMatrixOf<State> J = boxminus_jacobian(prior, offset);
  const ErrorMatrixOf<State> weighted = J.transpose() * prior_information;
  return {offset, weighted * offset, weighted * J};
}

/// The Kalman update in information form: the belief after fusing `measurements`, linearized at
/// `linearization`, with the prior mean `prior` and inverse prior covariance `prior_information`.
/// With linearization == prior it is the standard update, otherwise one step of the iterated
/// update. The covariance is that of the error about the returned state.
template <class State>
BeliefOf<State> kalman_update(const State& prior, const ErrorMatrixOf<State>& prior_information,
                              const State& linearization,
                              const InformationOf<State>& measurements) {
  using Matrix = ErrorMatrixOf<State>;
  const auto at = shifted_prior(prior, prior_information, linearization);
  const Matrix covariance = inverse_spd(Matrix(at.information + measurements.matrix));
  const ErrorVectorOf<State> delta = -covariance * (at.pull + measurements.vector);
  const Matrix G = reset_jacobian(linearization, delta);
  return {boxplus(linearization, delta), G * covariance * G.transpose()};
}

/// The same with the gain K replaced by `gain_mask` K (Schmidt-Kalman update): masked directions
/// keep their value and their uncertainty. The covariance is Joseph's form for this gain.
template <class State>
BeliefOf<State> kalman_update(const State& prior, const ErrorMatrixOf<State>& prior_information,
                              const State& linearization, const InformationOf<State>& measurements,
                              const ErrorMatrixOf<State>& gain_mask) {
  using Matrix = ErrorMatrixOf<State>;
  using Vector = ErrorVectorOf<State>;
  const auto at = shifted_prior(prior, prior_information, linearization);
  const Matrix full = inverse_spd(Matrix(at.information + measurements.matrix));
  const Vector step = -full * (at.pull + measurements.vector);
  // The mask applies to the total correction from the prior; the offset of it is already applied.
  const Vector delta = gain_mask * (at.offset + step) - at.offset;
  // Joseph's form with K H = C A and K R K^T = C A C^T, C = gain.
  const Matrix gain = gain_mask * full;
  const Matrix kept = Matrix::Identity() - gain * measurements.matrix;
  const Matrix covariance = kept * inverse_spd(at.information) * kept.transpose() +
                            gain * measurements.matrix * gain.transpose();
  const Matrix G = reset_jacobian(linearization, delta);
  return {boxplus(linearization, delta),
          G * (0.5 * (covariance + covariance.transpose())) * G.transpose()};
}

/// What a measurement holds at one linearization.
template <class State>
struct Linearization {
  InformationOf<State> information;
  std::optional<ErrorMatrixOf<State>> gain_mask;  ///< empty: every state is corrected
};

/// kalman_update() with or without a mask.
template <class State>
BeliefOf<State> kalman_update(const State& prior, const ErrorMatrixOf<State>& prior_information,
                              const State& at, const Linearization<State>& measurement) {
  return measurement.gain_mask
             ? kalman_update(prior, prior_information, at, measurement.information,
                             *measurement.gain_mask)
             : kalman_update(prior, prior_information, at, measurement.information);
}

/// How an iterated update ended.
template <class State>
struct IteratedUpdate {
  BeliefOf<State> belief;  ///< the prior when the measurement was refused
  int iterations = 0;      ///< steps taken
  bool converged = false;  ///< the last step was small
  bool refused = false;    ///< a linearization gave no measurement
};

/// The iterated update: up to `max_iterations` steps, each linearized at the result of the last.
/// `linearize(state)` returns the measurement there (std::optional<Linearization<State>>), empty to
/// refuse it: then the prior stays. `converged(before, after)` tells whether a step was small.
template <class State, class Linearize, class Converged>
IteratedUpdate<State> iterated_update(const BeliefOf<State>& prior,
                                      const ErrorMatrixOf<State>& prior_information,
                                      int max_iterations, Linearize&& linearize,
                                      Converged&& converged) {
  IteratedUpdate<State> update{prior};
  while (update.iterations < max_iterations && !update.converged) {
    const State before = update.belief.state;
    const std::optional<Linearization<State>> measurement = linearize(before);
    if (!measurement) return {prior, update.iterations, false, true};
    update.belief = kalman_update(prior.state, prior_information, before, *measurement);
    update.converged = converged(before, update.belief.state);
    ++update.iterations;
  }
  return update;
}

/// `gain_mask` with the leg states as consider states: not corrected.
ErrorMatrix consider_legs(ErrorMatrix gain_mask);

/// `gain_mask` with the correction of position and velocity multiplied by `factor` (3x3, odometry
/// axes).
ErrorMatrix limit_motion(ErrorMatrix gain_mask, const Eigen::Matrix3d& factor);

// Compiled once, in kalman_update.cpp.
extern template Belief kalman_update<NominalState>(const NominalState&, const ErrorMatrix&,
                                                   const NominalState&, const Information&);
extern template Belief kalman_update<NominalState>(const NominalState&, const ErrorMatrix&,
                                                   const NominalState&, const Information&,
                                                   const ErrorMatrix&);

}  // namespace aims
