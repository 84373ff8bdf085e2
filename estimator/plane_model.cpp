// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/plane_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// First-order covariance of the normal of `count` points about their two axes in the plane: their
/// error across it, taken from what is left of them but not below the map's, over their spread.
Eigen::Matrix3d normal_covariance(const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>& scatter,
                                  double count, const MapConfig& config) {
  const Eigen::Vector3d& variance = scatter.eigenvalues();
  const double seen = variance(0) * count / std::max(count - 3.0, 1.0);
  const double across = std::max(seen, config.map_sigma * config.map_sigma);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 1; i < 3; ++i) {
    const Eigen::Vector3d axis = scatter.eigenvectors().col(i);
    sum += across / (count * std::max(variance(i), 1e-12)) * axis * axis.transpose();
  }
  return sum;
}

}  // namespace

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
  plane.normal_covariance = normal_covariance(solver, static_cast<double>(points.size()), config);
  plane.valid = true;
  return plane;
}

}  // namespace aims
