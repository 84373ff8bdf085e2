// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include "estimator/baselines/lins/filter.hpp"

namespace aims::lins::test {

inline Eigen::Vector3d random_vector(std::mt19937& random, double scale) {
  std::normal_distribution<double> normal;
  return scale * Eigen::Vector3d(normal(random), normal(random), normal(random));
}

/// A state with nothing zero in it; rotations of about `angle` [rad].
inline State random_state(std::mt19937& random, double angle = 0.5) {
  State x;
  x.motion = {so3_exp(random_vector(random, angle)), random_vector(random, 1.0)};
  x.velocity = random_vector(random, 1.0);
  x.accelerometer_bias = random_vector(random, 0.1);
  x.gyro_bias = random_vector(random, 0.02);
  x.gravity = kGravity * random_vector(random, 1.0).normalized();
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

inline Inertial random_inertial(std::mt19937& random) {
  return {random_vector(random, 1.0), random_vector(random, 5.0)};
}

}  // namespace aims::lins::test
