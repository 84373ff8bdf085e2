// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include "estimator/baselines/leg_kilo/filter.hpp"

namespace aims::leg_kilo::test {

inline Eigen::Vector3d random_vector(std::mt19937& random, double scale) {
  std::normal_distribution<double> normal;
  return scale * Eigen::Vector3d(normal(random), normal(random), normal(random));
}

/// A state with nothing zero in it.
inline State random_state(std::mt19937& random) {
  State x;
  x.T_world_body = {so3_exp(random_vector(random, 0.7)), random_vector(random, 3.0)};
  x.velocity = random_vector(random, 1.0);
  x.accelerometer_bias = random_vector(random, 0.1);
  x.gyro_bias = random_vector(random, 0.02);
  x.gravity = 9.81 * random_vector(random, 1.0).normalized();
  x.force = random_vector(random, 5.0);
  x.rate = random_vector(random, 1.0);
  return x;
}

/// A covariance with correlations everywhere.
inline ErrorMatrix random_covariance(std::mt19937& random, double sigma) {
  std::normal_distribution<double> normal;
  const ErrorMatrix root = sigma * ErrorMatrix::NullaryExpr([&] { return normal(random); });
  return root * root.transpose() + 1e-3 * sigma * sigma * ErrorMatrix::Identity();
}

}  // namespace aims::leg_kilo::test
