// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/local_map.hpp"

#include <algorithm>
#include <vector>

namespace aims::fast_lio2 {
namespace {

/// Fraction of the free distance that the cube moves, as published.
constexpr double kMove = 0.9 * 0.5;

}  // namespace

Insertion insertion_of(const Eigen::Vector3f& point, const Neighbours& neighbours,
                       const PointMap& map, double voxel) {
  if (neighbours.count == 0) return Insertion::kVoxel;
  const Eigen::Vector3f centre = map.voxel_centre(point);
  const auto half = static_cast<float>(0.5 * voxel);
  if (((neighbours.points.front() - centre).array().abs() > half).all()) {
    return Insertion::kUnchecked;
  }
  if (neighbours.count < kNeighbours) return Insertion::kVoxel;
  const float distance = (point - centre).squaredNorm();
  const bool nearer = std::ranges::any_of(neighbours.points, [&](const Eigen::Vector3f& other) {
    return (other - centre).squaredNorm() < distance;
  });
  return nearer ? Insertion::kNone : Insertion::kVoxel;
}

void LocalCube::follow(const Eigen::Vector3d& position, PointMap& map) {
  const Eigen::Vector3f at = position.cast<float>();
  if (!cube_) {
    const auto half = static_cast<float>(0.5 * config_.cube);
    cube_ = {at.array() - half, at.array() + half};
    return;
  }
  const double margin = config_.moving_factor * config_.detection_range;
  const auto move =
      static_cast<float>(std::max(kMove * (config_.cube - 2.0 * margin),
                                  config_.detection_range * (config_.moving_factor - 1.0)));
  const Box old = *cube_;
  for (int axis = 0; axis < 3; ++axis) {
    Box left = old;
    if (at(axis) - old.min(axis) <= margin) {
      left.min(axis) = old.max(axis) - move;
      cube_->min(axis) -= move;
      cube_->max(axis) -= move;
    } else if (old.max(axis) - at(axis) <= margin) {
      left.max(axis) = old.min(axis) + move;
      cube_->min(axis) += move;
      cube_->max(axis) += move;
    } else {
      continue;
    }
    map.remove(left);
  }
}

void insert_scan(std::span<const Eigen::Vector3f> points, std::span<const Neighbours> neighbours,
                 double voxel, PointMap& map) {
  std::vector<Insertion> insertions;
  for (std::size_t i = 0; i < points.size(); ++i) {
    insertions.push_back(insertion_of(points[i], neighbours[i], map, voxel));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (insertions[i] == Insertion::kVoxel) map.add_to_voxel(points[i]);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (insertions[i] == Insertion::kUnchecked) map.add(points[i]);
  }
}

}  // namespace aims::fast_lio2
