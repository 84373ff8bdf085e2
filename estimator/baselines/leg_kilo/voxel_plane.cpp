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

PlaneTree& PlaneTree::child_of(const Eigen::Vector3d& point) {
  const Eigen::Array<bool, 3, 1> upper = point.array() > centre_.array();
  const int index = 4 * upper.x() + 2 * upper.y() + upper.z();
  std::unique_ptr<PlaneTree>& child = children_[static_cast<std::size_t>(index)];
  if (!child) {
    const Eigen::Vector3d sign = 2.0 * upper.cast<double>() - 1.0;
    child = std::make_unique<PlaneTree>(centre_ + 0.25 * edge_ * sign, 0.5 * edge_, layer_ + 1);
  }
  return *child;
}

void PlaneTree::fit(const Map& config) {
  plane_ = fit_plane(points_, config.max_eigenvalue);
  new_points_ = 0;
}

void PlaneTree::finish() {
  final_ = true;
  std::vector<MapPoint>().swap(points_);
  new_points_ = 0;
}

void PlaneTree::build(const Map& config) {
  if (points_.size() <= static_cast<std::size_t>(config.min_points)) return;
  fit(config);
  built_ = true;
  if (!plane_) {
    divide(config);
  } else if (points_.size() > static_cast<std::size_t>(config.max_points)) {
    finish();
  }
}

/// Hands the points on to eight smaller voxels, unless this one is of the last layer.
void PlaneTree::divide(const Map& config) {
  if (layer_ >= config.layers) return;
  for (const MapPoint& point : points_) child_of(point.position).collect(point);
  std::vector<MapPoint>().swap(points_);
  for (const auto& child : children_) {
    if (child) child->build(config);
  }
}

void PlaneTree::add_to_plane(const MapPoint& point, const Map& config) {
  if (final_) return;
  // As published: a voxel without a plane takes one point more.
  const std::size_t limit = static_cast<std::size_t>(config.max_points) + (plane_ ? 0U : 1U);
  points_.push_back(point);
  if (++new_points_ > config.refit_points) fit(config);
  if (points_.size() >= limit) finish();
}

void PlaneTree::add(const MapPoint& point, const Map& config) {
  if (!built_) {
    points_.push_back(point);
    ++new_points_;
    build(config);
  } else if (plane_ || layer_ >= config.layers) {
    add_to_plane(point, config);
  } else {
    child_of(point.position).add(point, config);
  }
}

}  // namespace aims::leg_kilo
