// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "estimator/interface/diagnostics.hpp"

namespace aims::points {

/// Three entries of an error vector, from a block's first on.
template <int kSize>
auto part(Eigen::Matrix<double, kSize, 1>& vector, int block) {
  return vector.template segment<3>(block);
}
template <int kSize>
auto part(const Eigen::Matrix<double, kSize, 1>& vector, int block) {
  return vector.template segment<3>(block);
}

/// The 3x3 block of two blocks of three entries.
template <int kSize>
auto part(Eigen::Matrix<double, kSize, kSize>& matrix, int row, int column) {
  return matrix.template block<3, 3>(row, column);
}
template <int kSize>
auto part(const Eigen::Matrix<double, kSize, kSize>& matrix, int row, int column) {
  return matrix.template block<3, 3>(row, column);
}

/// Position in the body frame and rotation of a filter with a state and the covariance of its
/// error, whose blocks `Error` names.
template <class Error, class Belief>
PoseCovariance pose_covariance(const Belief& belief) {
  const Eigen::Matrix3d R = belief.state.T_world_body.R();
  const auto& P = belief.covariance;
  return {R.transpose() * part(P, Error::kPosition, Error::kPosition) * R,
          part(P, Error::kRotation, Error::kRotation)};
}

}  // namespace aims::points
