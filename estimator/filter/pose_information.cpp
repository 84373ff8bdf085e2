// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/pose_information.hpp"

#include <Eigen/LU>

namespace aims {
namespace {

constexpr double kLeastOther = 1e-9;  ///< information about the other block: it can be inverted

}  // namespace

Eigen::Matrix3d schur_complement(const Eigen::Matrix3d& block, const Eigen::Matrix3d& cross,
                                 const Eigen::Matrix3d& other) {
  const Eigen::Matrix3d covariance = (other + kLeastOther * Eigen::Matrix3d::Identity()).inverse();
  const Eigen::Matrix3d rest = block - cross * covariance * cross.transpose();
  return 0.5 * (rest + rest.transpose());
}

Eigen::Matrix3d position_information(const Matrix6& information) {
  return schur_complement(information.bottomRightCorner<3, 3>(),
                          information.bottomLeftCorner<3, 3>(), information.topLeftCorner<3, 3>());
}

}  // namespace aims
