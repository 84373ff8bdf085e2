// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/axis_weights.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Keeps a block without information invertible; far below the information of one return.
constexpr double kRegularization = 1e-9;

}  // namespace

Eigen::Matrix3d AxisWeights::real_fraction() const {
  return axes * fraction.asDiagonal() * axes.transpose();
}

Eigen::Matrix3d AxisWeights::gain_factor() const {
  return axes * acceptance.asDiagonal() * axes.transpose();
}

AxisWeights weigh_axes(const Eigen::Matrix3d& information, const Eigen::Matrix3d& noise,
                       const Eigen::Matrix3d& axes, double threshold,
                       const NoiseInformationConfig& config) {
  AxisWeights weights;
  weights.axes = axes;
  const Eigen::Matrix3d covariance =
      (information + kRegularization * Eigen::Matrix3d::Identity()).inverse();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = axes.col(i);
    const double along = 1.0 / axis.dot(covariance * axis);
    const double from_noise = config.scale * axis.dot(noise * axis);
    const double ratio = std::max(along, 0.0) / std::max(from_noise, kRegularization);
    weights.ratio(i) = ratio;
    weights.probability(i) = acceptance_probability(ratio, threshold, config);
    weights.fraction(i) = ratio > 1.0 ? (ratio - 1.0) / ratio : 0.0;
  }
  weights.acceptance = weights.probability;
  return weights;
}

Eigen::Matrix3d persistent_axes(const Eigen::Matrix3d& information, const Eigen::Matrix3d& axes,
                                double tolerance) {
  const Eigen::Matrix3d split = axes.transpose() * information * axes;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      // A rotation by a small angle a makes the off-diagonal entry a (lambda_i - lambda_j).
      const double larger = std::max(split(i, i), split(j, j));
      if (std::abs(split(i, j)) > tolerance * larger) {
        return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvectors();
      }
    }
  }
  return axes;
}

void AxisWeigher::assess(Block& block, const Eigen::Matrix3d& information,
                         const Eigen::Matrix3d& noise, double gain) {
  // The noise starts at its first value, the information at zero.
  if (block.noise.isZero(0.0)) block.noise = noise;
  block.information += gain * (information - block.information);
  block.noise += gain * (noise - block.noise);
  const Eigen::Matrix3d axes =
      persistent_axes(block.information, block.weights.axes, config_.axis_tolerance);
  block.weights = weigh_axes(block.information, block.noise, axes,
                             significance_threshold(config_, distance_), config_);
  if (distance_ < config_.bootstrap_distance) block.weights.acceptance.setOnes();
}

void AxisWeigher::assess(const Matrix6& A, const Matrix6& noise, const Eigen::Matrix3d& R,
                         double distance) {
  distance_ += distance;
  const double gain = 1.0 - std::exp(-distance / config_.averaging_distance);
  const Eigen::Matrix3d A_rotation = A.topLeftCorner<3, 3>();
  const Eigen::Matrix3d A_position = A.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d cross = A.bottomLeftCorner<3, 3>();
  assess(position_, schur_complement(A_position, cross, A_rotation),
         noise.bottomRightCorner<3, 3>(), gain);
  assess(rotation_, R * schur_complement(A_rotation, cross.transpose(), A_position) * R.transpose(),
         R * noise.topLeftCorner<3, 3>() * R.transpose(), gain);
}

Matrix6 AxisWeigher::real_fraction(const Eigen::Matrix3d& R) const {
  Matrix6 F = Matrix6::Zero();
  F.topLeftCorner<3, 3>() = R.transpose() * rotation_.weights.real_fraction() * R;
  F.bottomRightCorner<3, 3>() = position_.weights.real_fraction();
  return F;
}

}  // namespace aims
