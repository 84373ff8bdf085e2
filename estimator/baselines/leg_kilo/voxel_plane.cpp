// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/voxel_plane.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace aims::leg_kilo {

double VoxelPlane::distance_variance(const Eigen::Vector3d& point) const {
  Eigen::Matrix<double, 6, 1> derivative;
  derivative << point - centre, -normal;
  return derivative.dot(covariance * derivative);
}

Eigen::Matrix<double, 6, 3> plane_derivative(const Eigen::Vector3d& offset,
                                             const Eigen::Matrix3d& axes,
                                             const Eigen::Vector3d& eigenvalues, double count) {
  const Eigen::Vector3d normal = axes.col(0);
  Eigen::Matrix3d of_normal = Eigen::Matrix3d::Zero();
  for (int i = 1; i < 3; ++i) {
    const Eigen::Vector3d axis = axes.col(i);
    const Eigen::Vector3d row = offset.dot(axis) * normal + offset.dot(normal) * axis;
    of_normal += axis * row.transpose() / (count * (eigenvalues(0) - eigenvalues(i)));
  }
  Eigen::Matrix<double, 6, 3> derivative;
  derivative << of_normal, Eigen::Matrix3d::Identity() / count;
  return derivative;
}

std::optional<VoxelPlane> fit_plane(std::span<const MapPoint> points, double max_eigenvalue) {
  const auto count = static_cast<double>(points.size());
  VoxelPlane plane;
  for (const MapPoint& each : points) plane.centre += each.position;
  plane.centre /= count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const MapPoint& each : points) {
    const Eigen::Vector3d offset = each.position - plane.centre;
    spread += offset * offset.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread / count);
  const Eigen::Vector3d& eigenvalues = solver.eigenvalues();
  // Points on a line or at a point have a plane, too, but its covariance must be a number.
  if (!(eigenvalues(0) < max_eigenvalue) || !(eigenvalues(1) > eigenvalues(0))) return std::nullopt;
  plane.normal = solver.eigenvectors().col(0);
  plane.radius = std::sqrt(eigenvalues(2));
  for (const MapPoint& each : points) {
    const Eigen::Matrix<double, 6, 3> J =
        plane_derivative(each.position - plane.centre, solver.eigenvectors(), eigenvalues, count);
    plane.covariance += J * each.covariance * J.transpose();
  }
  return plane;
}

}  // namespace aims::leg_kilo
