// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/time.hpp"

namespace aims {

/// Fisher information of one LiDAR scan about the pose of the body at the scan's end, for a known
/// map: that of its true returns at the true pose. Rotation first, then translation, both as right
/// perturbations in body axes: T = T_true (Exp(rotation), translation).
struct ScanInformation {
  Time stamp = 0;  ///< true end of the scan
  /// [1/rad^2, 1/(rad m); 1/(rad m), 1/m^2]
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  int returns = 0;           ///< summed over
  double range_sigma = 0.0;  ///< white noise of each range: the mean, as 1 / sigma^2 [m]
};

}  // namespace aims
