// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/plane_model.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace aims {

Plane fit_plane(std::span<const Eigen::Vector3f> points, const MapConfig& config) {
  Plane plane;
  if (points.size() < 3) return plane;
  for (const Eigen::Vector3f& p : points) plane.point += p.cast<double>();
  plane.point /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d d = p.cast<double>() - plane.point;
    scatter.noalias() += d * d.transpose();
  }
  scatter /= static_cast<double>(points.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter);
  plane.normal = solver.eigenvectors().col(0);
  const double smallest = solver.eigenvalues()(0);
  const double second = solver.eigenvalues()(1);
  if (!plane.normal.allFinite()) return plane;
  if (second < config.plane_min_spread * config.plane_min_spread) return plane;
  if (second < config.plane_min_ratio * smallest) return plane;
  for (const Eigen::Vector3f& p : points) {
    const double distance = plane.normal.dot(p.cast<double>() - plane.point);
    if (std::abs(distance) > config.plane_thickness) return plane;
  }
  plane.valid = true;
  return plane;
}

}  // namespace aims
