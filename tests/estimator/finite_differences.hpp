// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Eigenvalues>

#include "estimator/filter/error_state.hpp"

namespace aims::test {

/// Central-difference Jacobian of `function` (NominalState -> vector of `rows` entries) in the
/// error of `state`.
template <int rows, class Function>
Eigen::Matrix<double, rows, ErrorState::kSize> numeric_jacobian(const NominalState& state,
                                                                const Function& function) {
  constexpr double kStep = 1e-5;
  Eigen::Matrix<double, rows, ErrorState::kSize> jacobian;
  for (int i = 0; i < ErrorState::kSize; ++i) {
    const ErrorVector step = kStep * ErrorVector::Unit(i);
    jacobian.col(i) =
        (function(boxplus(state, step)) - function(boxplus(state, -step))) / (2.0 * kStep);
  }
  return jacobian;
}

/// A state with nothing zero in it.
inline NominalState some_state() {
  NominalState state;
  state.rotation = so3_exp({0.3, -0.2, 1.1});
  state.position = {4.0, -2.0, 0.5};
  state.velocity = {0.8, -0.3, 0.2};
  state.gyro_bias = {0.01, -0.02, 0.03};
  state.accelerometer_bias = {0.1, 0.2, -0.1};
  state.leg_scale = {0.05, -0.03, 0.1};
  state.leg_bias = {0.02, -0.01, 0.03};
  state.mount = so3_exp({0.02, 0.01, -0.03});
  state.delay = 0.004;
  return state;
}

/// S with S S^T = `covariance`, which may be singular.
inline ErrorMatrix square_root(const ErrorMatrix& covariance) {
  const Eigen::SelfAdjointEigenSolver<ErrorMatrix> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace aims::test
