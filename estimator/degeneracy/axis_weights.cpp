// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/axis_weights.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Keeps a block without any information invertible; far below one return's.
constexpr double kNothing = 1e-9;

Eigen::Matrix3d inverse(const Eigen::Matrix3d& information) {
  return (information + kNothing * Eigen::Matrix3d::Identity()).inverse();
}

}  // namespace

Eigen::Matrix3d schur_complement(const Eigen::Matrix3d& block, const Eigen::Matrix3d& cross,
                                 const Eigen::Matrix3d& other) {
  const Eigen::Matrix3d rest = block - cross * inverse(other) * cross.transpose();
  return 0.5 * (rest + rest.transpose());
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

double significant_ratio(const SpuriousConfig& config, double way) {
  return config.significant * (1.0 + config.start_excess * std::exp(-way / config.start_way));
}

double reality(double ratio, double significant, const SpuriousConfig& config) {
  if (!(ratio > 0.0)) return 0.0;
  const double deviations = std::log(ratio / significant) / config.spread;
  return 0.5 * std::erfc(-deviations / std::sqrt(2.0));
}

Eigen::Matrix3d BlockWeights::shrink() const {
  return axes * taken.cwiseProduct(share).cwiseSqrt().asDiagonal() * axes.transpose();
}

Eigen::Matrix3d BlockWeights::pull() const {
  return axes * taken.cwiseProduct(whole).asDiagonal() * axes.transpose();
}

BlockWeights weigh_block(const Eigen::Matrix3d& information, const Eigen::Matrix3d& chance,
                         const Eigen::Matrix3d& axes, double significant,
                         const SpuriousConfig& config) {
  BlockWeights block;
  block.axes = axes;
  const Eigen::Matrix3d covariance = inverse(information);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = axes.col(i);
    const double known = 1.0 / axis.dot(covariance * axis);
    const double by_chance = config.chance_share * axis.dot(chance * axis);
    const double ratio = std::max(known, 0.0) / std::max(by_chance, kNothing);
    block.ratio(i) = ratio;
    block.real(i) = reality(ratio, significant, config);
    block.share(i) = ratio > 1.0 ? (ratio - 1.0) / ratio : 0.0;
    block.whole(i) = std::min(config.amplification * block.share(i), 1.0);
  }
  block.taken = block.real;
  return block;
}

Eigen::Matrix3d steady_axes(const Eigen::Matrix3d& information, const Eigen::Matrix3d& axes,
                            double tolerance) {
  const Eigen::Matrix3d split = axes.transpose() * information * axes;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      // A rotation by the angle a moves a * (difference of the variances) off the diagonal.
      const double greater = std::max(split(i, i), split(j, j));
      if (std::abs(split(i, j)) > tolerance * greater) {
        return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvectors();
      }
    }
  }
  return axes;
}

void AxisWeigher::assess(Block& block, const Eigen::Matrix3d& information,
                         const Eigen::Matrix3d& chance, double share) {
  // Chance starts as it is, information from nothing.
  if (block.smoothed_chance.isZero(0.0)) block.smoothed_chance = chance;
  block.smoothed += share * (information - block.smoothed);
  block.smoothed_chance += share * (chance - block.smoothed_chance);
  const Eigen::Matrix3d axes = steady_axes(block.smoothed, block.now.axes, config_.axis_tolerance);
  block.now = weigh_block(block.smoothed, block.smoothed_chance, axes,
                          significant_ratio(config_, way_), config_);
  if (way_ < config_.trusting_way) block.now.taken.setOnes();
}

void AxisWeigher::assess(const Matrix6& A, const Matrix6& chance, const Eigen::Matrix3d& R,
                         double way) {
  way_ += way;
  const double share = 1.0 - std::exp(-way / config_.stretch);
  const Eigen::Matrix3d turning = A.topLeftCorner<3, 3>();
  const Eigen::Matrix3d moving = A.bottomRightCorner<3, 3>();
  const Eigen::Matrix3d cross = A.bottomLeftCorner<3, 3>();
  assess(position_, schur_complement(moving, cross, turning), chance.bottomRightCorner<3, 3>(),
         share);
  assess(rotation_, R * schur_complement(turning, cross.transpose(), moving) * R.transpose(),
         R * chance.topLeftCorner<3, 3>() * R.transpose(), share);
}

KeptOfScan AxisWeigher::kept(const Eigen::Matrix3d& R) const {
  KeptOfScan kept{Matrix6::Zero(), Matrix6::Zero()};
  kept.T.topLeftCorner<3, 3>() = R.transpose() * rotation_.now.shrink() * R;
  kept.T.bottomRightCorner<3, 3>() = position_.now.shrink();
  kept.P.topLeftCorner<3, 3>() = R.transpose() * rotation_.now.pull() * R;
  kept.P.bottomRightCorner<3, 3>() = position_.now.pull();
  return kept;
}

}  // namespace aims
