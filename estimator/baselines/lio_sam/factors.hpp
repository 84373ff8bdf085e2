// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/lio_sam/preintegration.hpp"
#include "estimator/baselines/pose_graph/factor_graph.hpp"

namespace aims::lio_sam {

// W of the biases: accelerometer before gyro.

using pose_graph::Factor;
using pose_graph::FactorGraph;
using pose_graph::Value;

/// The velocity is `mean` [m/s].
Factor velocity_prior(int velocity, const Eigen::Vector3d& mean,
                      const Eigen::MatrixXd& sqrt_information);

/// The biases are `mean`.
Factor bias_prior(int bias, const ImuBias& mean, const Eigen::MatrixXd& sqrt_information);

/// The biases stay.
Factor bias_walk(int from, int to, const Eigen::MatrixXd& sqrt_information);

/// Variables of an instant.
struct Key {
  int pose = 0;
  int velocity = 0;
  int bias = 0;
};

/// The motion from one instant to the next is that of the IMU, with the bias of the first:
///     r = (Log(D_R^T R_i^T R_j), R_i^T (v_j - v_i - g t) - D_v,
///          R_i^T (p_j - p_i - v_i t - g t^2 / 2) - D_p)
/// Empty when the motion has no samples.
std::optional<Factor> imu_factor(const Key& from, const Key& to, const Preintegration& motion,
                                 double gravity);

}  // namespace aims::lio_sam
