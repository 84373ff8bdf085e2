// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Smallest second principal deviation of the points of a plane: the jamb of a door 15 cm deep has
/// 4.3 cm (docs/decisions.md) [m].
constexpr double kMinSpread = 0.05;

/// Smallest ratio of the second to the smallest principal variance; docs/decisions.md.
constexpr double kMinRatio = 10.0;

}  // namespace

PrincipalPlane principal_plane(const Eigen::Vector3d& mean, const Eigen::Matrix3d& scatter) {
  PrincipalPlane fit;
  Plane& plane = fit.plane;
  plane.point = mean;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter);
  plane.normal = solver.eigenvectors().col(0);
  const double across = std::max(solver.eigenvalues()(0), 0.0);
  fit.variance = across;
  const double second = solver.eigenvalues()(1);
  plane.valid =
      plane.normal.allFinite() && second >= kMinSpread * kMinSpread && second >= kMinRatio * across;
  return fit;
}

Plane fit_plane(std::span<const Eigen::Vector3f> points) {
  if (points.size() < 3) return {};
  const auto count = static_cast<double>(points.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : points) mean += p.cast<double>();
  mean /= count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d d = p.cast<double>() - mean;
    scatter.noalias() += d * d.transpose();
  }
  scatter /= count;
  Plane plane = principal_plane(mean, scatter).plane;
  if (!plane.valid) return plane;
  for (const Eigen::Vector3f& p : points) {
    const double distance = plane.normal.dot(p.cast<double>() - plane.point);
    plane.thickness = std::max(plane.thickness, std::abs(distance));
  }
  return plane;
}

}  // namespace aims
