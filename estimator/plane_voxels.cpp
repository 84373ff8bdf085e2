// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/plane_voxels.hpp"

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
  ++insertions_;
  for (Level& level : levels_) {
    for (const Eigen::Vector3f& point : points) {
      if (point.allFinite()) insert(level, point);
    }
    if (level.voxels.size() > static_cast<std::size_t>(config_.max_voxels)) {
      drop_far(level, center);
    }
  }
}

void PlaneVoxels::insert(Level& level, const Eigen::Vector3f& point) const {
  const std::uint64_t key = voxel_key(voxel_of(point, level.inverse_size));
  const auto next = static_cast<std::int32_t>(level.voxels.size());
  const std::int32_t at = level.index.find_or_insert(key, next);
  if (at == next) {
    level.voxels.emplace_back().key = key;
    level.voxels.back().origin = point.cast<double>();
  }
  Voxel& voxel = level.voxels[at];
  voxel.seen = insertions_;
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
    const std::int32_t at = level.index.find(voxel_key(voxel_of(query, level.inverse_size)));
    if (at == VoxelHash::kNone) return none_;
    const Voxel& voxel = level.voxels[at];
    if (voxel.count < kFewest) continue;
    if (voxel.fitted == 0 || voxel.count >= kGrowth * voxel.fitted) fit(voxel, level.min_spread);
    if (voxel.plane.valid) return voxel.plane;
  }
  return none_;
}

void PlaneVoxels::drop_far(Level& level, const Eigen::Vector3f& center) const {
  const Eigen::Vector3d from = center.cast<double>();
  const auto squared_distance = [&from](const Voxel& v) { return (v.origin - from).squaredNorm(); };
  std::vector<double> distances(level.voxels.size());
  std::transform(level.voxels.begin(), level.voxels.end(), distances.begin(), squared_distance);
  const auto most = static_cast<std::size_t>(config_.max_voxels);
  const std::size_t kept = most - most / 10;
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(kept),
                   distances.end());
  const double limit = distances[kept];
  drop_if(level, [&](const Voxel& v) { return squared_distance(v) >= limit; });
}

void PlaneVoxels::forget_unseen(int insertions) {
  const auto age = static_cast<std::uint32_t>(std::max(insertions, 0));
  for (Level& level : levels_) {
    drop_if(level, [&](const Voxel& v) { return insertions_ - v.seen >= age; });
  }
}

template <class Predicate>
void PlaneVoxels::drop_if(Level& level, const Predicate& predicate) {
  if (std::erase_if(level.voxels, predicate) == 0) return;
  level.index.clear();
  for (std::size_t i = 0; i < level.voxels.size(); ++i) {
    level.index.find_or_insert(level.voxels[i].key, static_cast<std::int32_t>(i));
  }
}

std::size_t PlaneVoxels::memory() const {
  std::size_t sum = 0;
  for (const Level& level : levels_) {
    sum += level.voxels.capacity() * sizeof(Voxel) + level.index.memory();
  }
  return sum;
}

std::size_t PlaneVoxels::voxel_count() const {
  std::size_t count = 0;
  for (const Level& level : levels_) count += level.voxels.size();
  return count;
}

}  // namespace aims
