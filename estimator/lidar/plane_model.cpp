// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// First-order covariance of the normal of `count` points about their two axes in the plane: their
/// `variance` across it [m^2] over their spread.
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

}  // namespace

Plane plane_of_moments(const PointMoments& moments, double min_spread, const MapConfig& config) {
  Plane plane;
  plane.point = moments.mean;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.scatter);
  plane.normal = solver.eigenvectors().col(0);
  plane.thickness = std::sqrt(std::max(solver.eigenvalues()(0), 0.0));
  const double second = solver.eigenvalues()(1);
  if (!plane.normal.allFinite()) return plane;
  if (second < min_spread * min_spread) return plane;
  if (second < config.plane_min_ratio * solver.eigenvalues()(0)) return plane;
  const double left = solver.eigenvalues()(0) * moments.count / std::max(moments.count - 3.0, 1.0);
  plane.normal_covariance =
      normal_covariance(solver, moments.count, std::max(left, config.map_sigma * config.map_sigma));
  plane.valid = true;
  return plane;
}

Plane fit_plane(std::span<const Eigen::Vector3f> points, const MapConfig& config) {
  if (points.size() < 3) return {};
  PointMoments moments;
  moments.count = static_cast<double>(points.size());
  for (const Eigen::Vector3f& p : points) moments.mean += p.cast<double>();
  moments.mean /= moments.count;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d d = p.cast<double>() - moments.mean;
    moments.scatter.noalias() += d * d.transpose();
  }
  moments.scatter /= moments.count;
  Plane plane = plane_of_moments(moments, config.plane_min_spread, config);
  if (!plane.valid) return plane;
  for (const Eigen::Vector3f& p : points) {
    const double distance = plane.normal.dot(p.cast<double>() - plane.point);
    if (std::abs(distance) > config.plane_thickness) plane.valid = false;
  }
  return plane;
}

}  // namespace aims
