// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include "estimator/baselines/fast_lio2/state.hpp"

namespace aims::fast_lio2::test {

inline Eigen::Vector3d random_vector(std::mt19937& random, double scale) {
  std::normal_distribution<double> normal;
  return scale * Eigen::Vector3d(normal(random), normal(random), normal(random));
}

/// A state with nothing zero in it.
inline State random_state(std::mt19937& random) {
  State x;
  x.T_world_body = {so3_exp(random_vector(random, 0.7)), random_vector(random, 3.0)};
  x.T_body_lidar = {so3_exp(random_vector(random, 0.2)), random_vector(random, 0.1)};
  x.velocity = random_vector(random, 1.0);
  x.gyro_bias = random_vector(random, 0.02);
  x.accelerometer_bias = random_vector(random, 0.1);
  x.gravity = 9.81 * random_vector(random, 1.0).normalized();
  return x;
}

inline ErrorVector random_error(std::mt19937& random, double scale) {
  std::normal_distribution<double> normal;
  ErrorVector error;
  for (int i = 0; i < Error::kSize; ++i) error(i) = scale * normal(random);
  return error;
}

/// A covariance with correlations everywhere.
inline ErrorMatrix random_covariance(std::mt19937& random, double sigma) {
  ErrorMatrix root;
  for (int i = 0; i < Error::kSize; ++i) root.col(i) = random_error(random, sigma);
  return root * root.transpose() + 1e-3 * sigma * sigma * ErrorMatrix::Identity();
}

}  // namespace aims::fast_lio2::test
