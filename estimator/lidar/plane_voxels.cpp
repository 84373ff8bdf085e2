// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_voxels.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace aims {
namespace {

/// Fewest points of a plane.
constexpr int kFewest = 6;

/// Growth of the number of points that asks for a new fit.
constexpr double kGrowth = 1.2;

}  // namespace

PlaneVoxels::PlaneVoxels(const MapConfig& config) : config_(config) {
  double size = config.voxel_size;
  for (Level& level : levels_) {
    level.inverse_size = static_cast<float>(1.0 / size);
    level.min_spread = std::min(config.plane_min_spread, 0.2 * size);
    size /= 2.0;
  }
}

void PlaneVoxels::insert(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& center) {
  const Eigen::Vector3d from = center.cast<double>();
  for (Level& level : levels_) {
    level.voxels.begin_insertion();
    for (const Eigen::Vector3f& point : points) {
      if (point.allFinite()) insert(level, point);
    }
    level.voxels.limit(static_cast<std::size_t>(config_.max_voxels),
                       [&from](const Voxel& v) { return (v.origin - from).squaredNorm(); });
  }
}

void PlaneVoxels::insert(Level& level, const Eigen::Vector3f& point) const {
  Voxel& voxel = level.voxels.touch(voxel_key(voxel_of(point, level.inverse_size)));
  if (voxel.count == 0) voxel.origin = point.cast<double>();
  if (voxel.count >= config_.max_plane_points) return;
  const Eigen::Vector3d d = point.cast<double>() - voxel.origin;
  voxel.sum += d;
  voxel.squares.noalias() += d * d.transpose();
  ++voxel.count;
}

void PlaneVoxels::fit(const Voxel& voxel, double min_spread) const {
  voxel.fitted = voxel.count;
  PointMoments moments;
  moments.count = voxel.count;
  const Eigen::Vector3d mean = voxel.sum / moments.count;
  moments.mean = voxel.origin + mean;
  moments.scatter = voxel.squares / moments.count - mean * mean.transpose();
  voxel.plane = plane_of_moments(moments, min_spread, config_);
  if (voxel.plane.thickness > config_.plane_max_deviation) voxel.plane.valid = false;
}

const Plane& PlaneVoxels::plane_at(const Eigen::Vector3f& query) const {
  for (const Level& level : levels_) {
    const Voxel* voxel = level.voxels.find(voxel_key(voxel_of(query, level.inverse_size)));
    if (voxel == nullptr) return none_;
    if (voxel->count < kFewest) continue;
    if (voxel->fitted == 0 || voxel->count >= kGrowth * voxel->fitted) {
      fit(*voxel, level.min_spread);
    }
    if (voxel->plane.valid) return voxel->plane;
  }
  return none_;
}

void PlaneVoxels::forget_unseen(int insertions) {
  for (Level& level : levels_) level.voxels.forget_unseen(insertions);
}

std::size_t PlaneVoxels::memory() const {
  std::size_t sum = 0;
  for (const Level& level : levels_) sum += level.voxels.memory();
  return sum;
}

std::size_t PlaneVoxels::voxel_count() const {
  std::size_t count = 0;
  for (const Level& level : levels_) count += level.voxels.size();
  return count;
}

}  // namespace aims
