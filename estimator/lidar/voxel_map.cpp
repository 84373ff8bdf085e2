// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/voxel_map.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Offsets of the 27 voxels around one: itself first, then faces, edges and corners, so that near
/// neighbours are found early and the rest is pruned.
std::array<std::array<int, 3>, 27> neighborhood() {
  std::array<std::array<int, 3>, 27> offsets{};
  int i = 0;
  for (int order = 0; order <= 3; ++order) {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (x * x + y * y + z * z == order) offsets[i++] = {x, y, z};
        }
      }
    }
  }
  return offsets;
}

const std::array<std::array<int, 3>, 27> kNeighborhood = neighborhood();

/// Squared distance from a coordinate `inside` a voxel of edge `size` to its neighbour at `offset`.
float squared_gap(float inside, float size, int offset) {
  if (offset == 0) return 0.0F;
  const float gap = offset < 0 ? inside : size - inside;
  return gap * gap;
}

/// The plane of the points; valid only when the query lies among them.
Plane plane_among(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& query) {
  Plane plane = fit_plane(points);
  plane.valid = plane.valid && lies_among(points, plane, query);
  return plane;
}

}  // namespace

VoxelMap::VoxelMap(const MapConfig& config)
    : inverse_size_(static_cast<float>(1.0 / config.voxel_size)),
      size_(static_cast<float>(config.voxel_size)),
      spacing_(static_cast<float>(config.point_spacing)),
      max_voxels_(static_cast<std::size_t>(std::max(config.max_voxels, 1))) {}

void VoxelMap::insert(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& center,
                      const Eigen::Matrix3f& covariance) {
  voxels_.begin_insertion();
  for (const Eigen::Vector3f& point : points) {
    if (point.allFinite()) insert(point, half_, covariance);
  }
  end_insertion();
  voxels_.limit(max_voxels_,
                [&center](const Voxel& v) { return (v.first - center).squaredNorm(); });
}

/// Blocks grow from one scan, so that both halves soon have planes.
void VoxelMap::end_insertion() {
  if (++in_block_ < block_) return;
  in_block_ = 0;
  half_ = 1 - half_;
  if (half_ == 0) block_ = std::min(2 * block_, kLongestBlock);
}

PlanePair VoxelMap::planes_at(const Eigen::Vector3f& query) const {
  std::array<Neighbors, kHalves> neighbors;
  nearest(query, neighbors);
  for (const Neighbors& half : neighbors) {
    if (half.count < Neighbors::kWanted) return {};
  }
  PlanePair planes;
  planes.a = plane_among(neighbors[0].points, query);
  if (planes.a.valid) planes.b = plane_among(neighbors[1].points, query);
  return planes;
}

void VoxelMap::insert(const Eigen::Vector3f& point, std::size_t half,
                      const Eigen::Matrix3f& covariance) {
  Voxel& voxel = voxels_.touch(voxel_key(voxel_of(point, inverse_size_)));
  if (voxel.empty) {
    voxel.empty = false;
    voxel.first = point;
    voxel.covariance = covariance;
  }
  insert(point, voxel.halves[half]);
}

Eigen::Vector3f VoxelMap::Half::point(int i) const {
  const FourPoints& four = points[static_cast<std::size_t>(i / 4)];
  const auto k = static_cast<std::size_t>(i % 4);
  return {four.x[k], four.y[k], four.z[k]};
}

void VoxelMap::Half::set(int i, const Eigen::Vector3f& point) {
  FourPoints& four = points[static_cast<std::size_t>(i / 4)];
  const auto k = static_cast<std::size_t>(i % 4);
  four.x[k] = point.x();
  four.y[k] = point.y();
  four.z[k] = point.z();
}

/// Of the points of a half to `query`, in groups of four: up to three behind the last have no
/// meaning [m^2].
VoxelMap::SquaredDistances VoxelMap::squared_distances(const Half& half,
                                                       const Eigen::Vector3f& query) {
  SquaredDistances squared;
  for (std::size_t begin = 0; begin < static_cast<std::size_t>(half.count); begin += 4) {
    const FourPoints& four = half.points[begin / 4];
    for (std::size_t k = 0; k < 4; ++k) {
      const float dx = four.x[k] - query.x();
      const float dy = four.y[k] - query.y();
      const float dz = four.z[k] - query.z();
      squared[begin + k] = dx * dx + dy * dy + dz * dz;
    }
  }
  return squared;
}

void VoxelMap::insert(const Eigen::Vector3f& point, Half& half) const {
  const SquaredDistances squared = squared_distances(half, point);
  int closest = -1;
  float nearest = spacing_ * spacing_;
  for (int i = 0; i < half.count; ++i) {
    if (squared[i] < nearest) {
      nearest = squared[i];
      closest = i;
    }
  }
  if (closest >= 0) {
    if (half.merged[closest] >= kMaxMerges) return;
    const float weight = 1.0F / static_cast<float>(++half.merged[closest]);
    const Eigen::Vector3f mean = half.point(closest);
    half.set(closest, mean + weight * (point - mean));
  } else if (half.count < kCapacity) {
    half.merged[half.count] = 1;
    half.set(half.count++, point);
  }
}

Eigen::Matrix3f VoxelMap::covariance_at(const Eigen::Vector3f& point) const {
  const Voxel* voxel = voxels_.find(voxel_key(voxel_of(point, inverse_size_)));
  if (voxel == nullptr) return Eigen::Matrix3f::Zero();
  return voxel->covariance;
}

void VoxelMap::search(const Half& half, const Eigen::Vector3f& query, std::uint32_t voxel,
                      NearestPoints& nearest) {
  const SquaredDistances squared = squared_distances(half, query);
  for (int i = 0; i < half.count; ++i) {
    nearest.offer(squared[i], voxel * kCapacity + static_cast<std::uint32_t>(i));
  }
}

int VoxelMap::nearest(const Eigen::Vector3f& query,
                      std::array<Neighbors, kHalves>& neighbors) const {
  const VoxelIndex home = voxel_of(query, inverse_size_);
  const Eigen::Vector3f inside =
      query - size_ * Eigen::Vector3f(static_cast<float>(home.x), static_cast<float>(home.y),
                                      static_cast<float>(home.z));
  std::array<NearestPoints, kHalves> nearest{NearestPoints(size_ * size_),
                                             NearestPoints(size_ * size_)};
  std::array<const Voxel*, 27> voxels;
  std::uint32_t count = 0;
  for (const auto& [dx, dy, dz] : kNeighborhood) {
    const float closest = squared_gap(inside.x(), size_, dx) + squared_gap(inside.y(), size_, dy) +
                          squared_gap(inside.z(), size_, dz);
    if (closest > std::max(nearest[0].reach(), nearest[1].reach())) continue;
    const Voxel* voxel = voxels_.find(voxel_key({home.x + dx, home.y + dy, home.z + dz}));
    if (voxel == nullptr) continue;
    for (std::size_t half = 0; half < kHalves; ++half) {
      if (closest > nearest[half].reach()) continue;
      search(voxel->halves[half], query, count, nearest[half]);
    }
    voxels[count++] = voxel;
  }
  for (std::size_t half = 0; half < kHalves; ++half) {
    Neighbors& found = neighbors[half];
    found.count = nearest[half].count();
    for (int k = 0; k < found.count; ++k) {
      const std::uint32_t id = nearest[half].id(k);
      const Half& points = voxels[id / kCapacity]->halves[half];
      found.points[k] = points.point(static_cast<int>(id % kCapacity));
      found.squared_distances[k] = nearest[half].squared_distance(k);
    }
  }
  return static_cast<int>(count);
}

std::size_t VoxelMap::memory() const { return voxels_.memory(); }

std::vector<Eigen::Vector3f> VoxelMap::points() const {
  std::vector<Eigen::Vector3f> all;
  for (const Voxel& voxel : voxels_) {
    for (const Half& half : voxel.halves) {
      for (int i = 0; i < half.count; ++i) all.push_back(half.point(i));
    }
  }
  return all;
}

}  // namespace aims
