// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/pose_clone.hpp"

namespace aims {

PoseClone clone_pose(const Belief& belief) {
  return {belief.state.T_odom_body(), pose_block(belief.covariance), pose_rows(belief.covariance)};
}

PoseClone propagate_clone(const PoseClone& clone, const ErrorMatrix& F) {
  return {clone.T_odom_body, clone.covariance, clone.cross_covariance * F.transpose()};
}

LinearMeasurement marginalise_clone(const RelativeMeasurement& measurement, const PoseClone& clone,
                                    const ErrorMatrix& state_information) {
  const Matrix6xError regression = clone.cross_covariance * state_information;
  const Matrix6 remainder = clone.covariance - regression * clone.cross_covariance.transpose();
  const Matrix3x6& J = measurement.clone_jacobian;
  LinearMeasurement m;
  m.residual = measurement.residual;
  m.jacobian = measurement.jacobian + J * regression;
  const Eigen::Matrix3d noise = measurement.noise + J * remainder * J.transpose();
  m.noise = 0.5 * (noise + noise.transpose());
  return m;
}

}  // namespace aims
