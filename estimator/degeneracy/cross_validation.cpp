// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/cross_validation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace aims {
namespace {

/// Keeps a block without information invertible; far below the information of one return.
constexpr double kRegularization = 1e-9;
/// Smaller shifts between scans count as standing [m].
constexpr double kMinShift = 0.05;
/// kFreeDirection for a robot that has not moved: each scan repeats the same pattern of rings.
constexpr double kFreeStanding = 0.8;
/// Way over which information is averaged: a few times the reach of the neighbours of a plane, so
/// that the noise is seen several times anew [m].
constexpr double kAveragingDistance = 1.5;

/// The position block with the rotation unknown.
Eigen::Matrix3d position_information(const Matrix6& A) {
  return schur_complement(A.bottomRightCorner<3, 3>(), A.bottomLeftCorner<3, 3>(),
                          A.topLeftCorner<3, 3>());
}

}  // namespace

void describe(Fields& f, CrossValidationConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "keep only the information in which both halves of the map agree"});
}

void RealFraction::add(const HalvesInformation& scan, const Eigen::Vector3d& position) {
  const double way = last_position_ ? (position - *last_position_).norm() : 0.0;
  const bool first = !last_position_;
  if (!first && way < kMinShift) return;
  last_position_ = position;
  const double gain = first ? 1.0 : 1.0 - std::exp(-way / kAveragingDistance);
  standing_ = first ? 1.0 : (1.0 - gain) * standing_;
  within_ += gain * (position_information(scan.within) - within_);
  across_ += gain * (position_information(scan.across) - across_);
  update_fraction();
}

void RealFraction::update_fraction() {
  // X V = W V diag(f) with V^T W V = I, so X W^-1 = W V diag(f) V^T.
  const Eigen::Matrix3d within = within_ + kRegularization * Eigen::Matrix3d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(across_, within);
  const Eigen::Matrix3d& V = solver.eigenvectors();
  const double free = kFreeDirection + standing_ * (kFreeStanding - kFreeDirection);
  const Eigen::Array3d beyond = (solver.eigenvalues().array() - free) / (1.0 - free);
  const Eigen::Vector3d fraction = beyond.max(0.0).min(1.0).matrix();
  weakest_ = fraction.minCoeff();
  constrained_.setIdentity();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = V.col(i).normalized();
    if (fraction(i) <= 0.0) constrained_ -= axis * axis.transpose();
  }
  position_fraction_ = within * V * fraction.asDiagonal() * V.transpose();
}

PoseInformation RealFraction::applied_to(const HalvesInformation& scan) const {
  Matrix6 F = Matrix6::Identity();
  F.bottomRightCorner<3, 3>() = position_fraction_;
  return {F * scan.within * F.transpose(), F * scan.across_vector};
}

Eigen::Matrix3d schur_complement(const Eigen::Matrix3d& block, const Eigen::Matrix3d& cross,
                                 const Eigen::Matrix3d& other) {
  const Eigen::Matrix3d covariance =
      (other + kRegularization * Eigen::Matrix3d::Identity()).inverse();
  const Eigen::Matrix3d rest = block - cross * covariance * cross.transpose();
  return 0.5 * (rest + rest.transpose());
}

double weakest_real_fraction(const HalvesInformation& scan) {
  const Eigen::Matrix3d within =
      position_information(scan.within) + kRegularization * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d across = position_information(scan.across);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(across, within,
                                                                         Eigen::EigenvaluesOnly);
  return solver.eigenvalues()(0);
}

}  // namespace aims
