// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/map_covariance.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace aims {
namespace {

/// Mean of the planes' variances along the unit `axis`, weighted by cos^2 of normal and axis.
double variance_along(const Eigen::Vector3d& axis, std::span<const MappedPlane> planes) {
  double sum = 0.0;
  double weights = 0.0;
  for (const MappedPlane& plane : planes) {
    const double cosine = plane.normal.dot(axis);
    sum += cosine * cosine * axis.dot(plane.covariance * axis);
    weights += cosine * cosine;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

}  // namespace

Eigen::Matrix3d map_covariance_after_scan(const Eigen::Matrix3d& map_covariance,
                                          const Eigen::Matrix3d& prior,
                                          const Eigen::Matrix3d& posterior,
                                          std::span<const MappedPlane> planes) {
  Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();
  for (const MappedPlane& plane : planes) normals += plane.normal * plane.normal.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(normals);
  Eigen::Matrix3d after = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = solver.eigenvectors().col(i);
    const double remaining = axis.dot(posterior * axis) / std::max(axis.dot(prior * axis), 1e-18);
    const double fraction = 1.0 - std::clamp(remaining, 0.0, 1.0);
    const double variance = (1.0 - fraction) * axis.dot(map_covariance * axis) +
                            fraction * variance_along(axis, planes);
    after += variance * axis * axis.transpose();
  }
  return after;
}

}  // namespace aims
