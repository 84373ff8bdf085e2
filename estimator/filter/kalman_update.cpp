// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/kalman_update.hpp"

#include <Eigen/LU>

namespace aims {

template Belief kalman_update<NominalState>(const NominalState&, const ErrorMatrix&,
                                            const NominalState&, const Information&);
template Belief kalman_update<NominalState>(const NominalState&, const ErrorMatrix&,
                                            const NominalState&, const Information&,
                                            const ErrorMatrix&);

Information information_of(const LinearMeasurement& measurement) {
  const Matrix3xError weighted = measurement.noise.inverse() * measurement.jacobian;
  return {measurement.jacobian.transpose() * weighted, weighted.transpose() * measurement.residual};
}

Information pose_information(const Matrix6& matrix, const Vector6& vector) {
  Information information;
  pose_block(information.matrix) = matrix;
  pose_segment(information.vector) = vector;
  return information;
}

ErrorMatrix consider_legs(ErrorMatrix gain_mask) {
  gain_mask.bottomRows<ErrorState::kSize - ErrorState::kMotionSize>().setZero();
  return gain_mask;
}

ErrorMatrix consider_position(ErrorMatrix gain_mask) {
  gain_mask.middleRows<3>(ErrorState::kPosition.offset).setZero();
  return gain_mask;
}

ErrorMatrix limit_motion(ErrorMatrix gain_mask, const Eigen::Matrix3d& factor) {
  block(gain_mask, ErrorState::kPosition, ErrorState::kPosition) = factor;
  block(gain_mask, ErrorState::kVelocity, ErrorState::kVelocity) = factor;
  return gain_mask;
}

ErrorMatrix limit_rotation(ErrorMatrix gain_mask, const Eigen::Matrix3d& factor) {
  block(gain_mask, ErrorState::kRotation, ErrorState::kRotation) = factor;
  return gain_mask;
}

}  // namespace aims
