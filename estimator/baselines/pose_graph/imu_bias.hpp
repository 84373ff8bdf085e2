// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace aims::pose_graph {

/// Biases of the IMU.
struct ImuBias {
  Eigen::Vector3d accelerometer = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();           ///< [rad/s]
};

}  // namespace aims::pose_graph
