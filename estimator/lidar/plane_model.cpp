// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// First-order covariance of the normal of `count` points: per axis in the plane, the `variance`
/// across it [m^2] over the sum of squares along it.
Eigen::Matrix3d normal_covariance(const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>& scatter,
                                  double count, double variance) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 1; i < 3; ++i) {
    const Eigen::Vector3d axis = scatter.eigenvectors().col(i);
    const double spread = std::max(scatter.eigenvalues()(i), 1e-12);
    sum += variance / (count * spread) * axis * axis.transpose();
  }
  return sum;
}

/// The least-squares plane of points with this mean and scatter [m^2]; valid when they spread in
/// two directions, and by the map's ratio more than across the plane.
Plane plane_of(const Eigen::Vector3d& mean, const Eigen::Matrix3d& scatter, double count,
               const MapConfig& config) {
  Plane plane;
  plane.point = mean;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(scatter);
  plane.normal = solver.eigenvectors().col(0);
  const double across = solver.eigenvalues()(0);
  const double second = solver.eigenvalues()(1);
  if (!plane.normal.allFinite()) return plane;
  if (second < config.plane_min_spread * config.plane_min_spread) return plane;
  if (second < config.plane_min_ratio * across) return plane;
  const double variance = across * count / std::max(count - 3.0, 1.0);
  plane.normal_covariance =
      normal_covariance(solver, count, std::max(variance, config.map_sigma * config.map_sigma));
  plane.valid = true;
  return plane;
}

}  // namespace

Plane fit_plane(std::span<const Eigen::Vector3f> points, const MapConfig& config) {
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
  Plane plane = plane_of(mean, scatter, count, config);
  if (!plane.valid) return plane;
  for (const Eigen::Vector3f& p : points) {
    const double distance = plane.normal.dot(p.cast<double>() - plane.point);
    if (std::abs(distance) > config.plane_thickness) plane.valid = false;
  }
  return plane;
}

}  // namespace aims
