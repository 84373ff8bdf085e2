// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/map_anchor.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace aims {
namespace {

/// Mean of the anchors' variances along the unit `axis`, weighted by what each plane tells of it.
double variance_along(const Eigen::Vector3d& axis, std::span<const AnchoredPlane> planes) {
  double sum = 0.0;
  double weights = 0.0;
  for (const AnchoredPlane& plane : planes) {
    const double cosine = plane.normal.dot(axis);
    sum += cosine * cosine * axis.dot(plane.anchor * axis);
    weights += cosine * cosine;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

}  // namespace

Eigen::Matrix3d anchor_after_scan(const Eigen::Matrix3d& anchor, const Eigen::Matrix3d& prior,
                                  const Eigen::Matrix3d& posterior,
                                  std::span<const AnchoredPlane> planes) {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  for (const AnchoredPlane& plane : planes) normals += plane.normal * plane.normal.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normals);
  Eigen::Matrix3d after = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = solver.eigenvectors().col(i);
    const double kept = axis.dot(posterior * axis) / std::max(axis.dot(prior * axis), 1e-18);
    const double share = 1.0 - std::clamp(kept, 0.0, 1.0);
    const double variance =
        (1.0 - share) * axis.dot(anchor * axis) + share * variance_along(axis, planes);
    after += variance * axis * axis.transpose();
  }
  return after;
}

}  // namespace aims
