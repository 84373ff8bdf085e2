// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/localizability.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Fraction of the largest eigenvalue below which an eigenvalue counts as zero.
constexpr double kRounding = 1e-9;

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

/// A generalized inverse of a positive semidefinite matrix (Moore and Penrose).
Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& matrix) {
  const Solver solver(matrix);
  const double floor = kRounding * solver.eigenvalues().cwiseAbs().maxCoeff();
  const Eigen::Vector3d inverse = solver.eigenvalues().unaryExpr(
      [floor](double value) { return value > floor ? 1.0 / value : 0.0; });
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

/// Information about one block when the `other` block is unknown as well.
BlockInformation schur_complement(const Eigen::Matrix3d& block, const Eigen::Matrix3d& cross,
                                  const Eigen::Matrix3d& other) {
  const Eigen::Matrix3d rest = block - cross * pseudo_inverse(other) * cross.transpose();
  const Solver solver(0.5 * (rest + rest.transpose()));
  const double floor = kRounding * std::max(0.0, Solver(block).eigenvalues()(2));
  BlockInformation result;
  result.axes = solver.eigenvectors();
  result.eigenvalues =
      solver.eigenvalues().unaryExpr([floor](double value) { return value > floor ? value : 0.0; });
  return result;
}

}  // namespace

BlockInformation translation_information(const Eigen::Matrix<double, 6, 6>& information) {
  return schur_complement(information.bottomRightCorner<3, 3>(),
                          information.bottomLeftCorner<3, 3>(), information.topLeftCorner<3, 3>());
}

BlockInformation rotation_information(const Eigen::Matrix<double, 6, 6>& information) {
  return schur_complement(information.topLeftCorner<3, 3>(), information.topRightCorner<3, 3>(),
                          information.bottomRightCorner<3, 3>());
}

double bound_of(double information) {
  if (!(information > 0.0)) return std::numeric_limits<double>::infinity();
  return 1.0 / std::sqrt(information);
}

Localizability localizability_of(const ScanInformation& scan, const Pose& T_world_body) {
  const BlockInformation translation = translation_information(scan.information);
  const BlockInformation rotation = rotation_information(scan.information);
  Localizability result;
  result.stamp = scan.stamp;
  result.returns = scan.returns;
  result.lambda_min = translation.eigenvalues(0);
  result.equivalent_returns = result.lambda_min * scan.range_sigma * scan.range_sigma;
  result.sigma = bound_of(result.lambda_min);
  result.weak_axis_in_body = translation.weak_axis();
  result.weak_axis_in_world = T_world_body.rotation * result.weak_axis_in_body;
  result.rotation_lambda_min = rotation.eigenvalues(0);
  result.rotation_sigma = bound_of(result.rotation_lambda_min);
  return result;
}

std::vector<Localizability> localizability_of(std::span<const ScanInformation> scans,
                                              const Trajectory& truth) {
  std::vector<Localizability> result;
  result.reserve(scans.size());
  for (const ScanInformation& scan : scans) {
    if (const auto pose = pose_at(truth, scan.stamp)) {
      result.push_back(localizability_of(scan, *pose));
    }
  }
  return result;
}

bool is_degenerate(const Localizability& scan, const DegeneracyLevel& level) {
  return scan.equivalent_returns < level.equivalent_returns;
}

}  // namespace aims
