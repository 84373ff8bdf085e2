// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/axis_weights.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace aims {

Matrix6 AxisWeights::weigh_matrix() const {
  return back * weights.cwiseProduct(ratio).asDiagonal() * back.transpose();
}

Vector6 AxisWeights::weigh_vector(const Vector6& b) const {
  return back * weights.cwiseProduct(axes.transpose() * b);
}

Matrix6 chance_information(const Eigen::Matrix3d& normal_covariance, const Eigen::Vector3d& p_body,
                           const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d turning = hat(p_body) * R.transpose();
  const Eigen::Matrix3d cross = turning * normal_covariance;
  Matrix6 sum;
  sum.topLeftCorner<3, 3>().noalias() = cross * turning.transpose();
  sum.topRightCorner<3, 3>() = cross;
  sum.bottomLeftCorner<3, 3>() = cross.transpose();
  sum.bottomRightCorner<3, 3>() = normal_covariance;
  return sum;
}

double reality(double ratio, const SpuriousConfig& config) {
  if (!(ratio > 0.0)) return 0.0;
  const double deviations = std::log(ratio / config.significant) / config.spread;
  return 0.5 * std::erfc(-deviations / std::sqrt(2.0));
}

AxisWeights weigh_axes(const Matrix6& A, const Matrix6& chance, const SpuriousConfig& config) {
  AxisWeights result;
  // A = (V^-T) D (V^-1) with V^T C V = I.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> solver(A, chance);
  if (solver.info() != Eigen::Success || !solver.eigenvectors().allFinite()) {
    result.ratio.setZero();
    result.weights.setZero();
    return result;
  }
  result.axes = solver.eigenvectors();
  result.back = chance * result.axes;  // V^-T = C V
  result.ratio = solver.eigenvalues().cwiseMax(0.0);
  for (int i = 0; i < result.ratio.size(); ++i) {
    const double ratio = result.ratio(i);
    result.weights(i) = ratio > 1.0 ? reality(ratio, config) * (ratio - 1.0) / ratio : 0.0;
  }
  return result;
}

}  // namespace aims
