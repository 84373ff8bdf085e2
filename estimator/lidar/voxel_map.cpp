// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/voxel_map.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// A voxel and those around it.
constexpr std::size_t kNeighborhood = 27;

/// Their offsets: itself first, then faces, edges and corners, so that near neighbours are found
/// early and the rest is pruned.
std::array<std::array<int, 3>, kNeighborhood> neighborhood() {
  std::array<std::array<int, 3>, kNeighborhood> offsets{};
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

const std::array<std::array<int, 3>, kNeighborhood> kOffsets = neighborhood();

/// Squared distances from the coordinate `at`, in voxel `home` of edge `size`, to the voxel before
/// it, to itself and to the next [m^2].
std::array<float, 3> squared_gaps(float at, std::int32_t home, float size) {
  const float inside = at - size * static_cast<float>(home);
  const float rest = size - inside;
  return {inside * inside, 0.0F, rest * rest};
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

void VoxelMap::insert(const Eigen::Vector3f& point, Half& half) const {
  int closest = -1;
  float nearest = spacing_ * spacing_;
  for (int begin = 0; begin < half.count; begin += 4) {
    const Float4 squared =
        half.points[static_cast<std::size_t>(begin / 4)].squared_distances(point);
    for (int k = 0; k < 4; ++k) {
      if (squared[k] < nearest) {
        nearest = squared[k];
        closest = begin + k;
      }
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

/// The voxels searched for one query, and the nearest points of each half in them.
struct VoxelMap::Search {
  Eigen::Vector3f query;
  std::array<NearestPoints, kHalves> nearest;
  std::array<float, kHalves> reach;  ///< farther points have no effect [m^2]
  std::array<const Voxel*, kNeighborhood> voxels;
  std::uint32_t count = 0;

  Search(const Eigen::Vector3f& point, float gate)
      : query(point), nearest{NearestPoints(gate), NearestPoints(gate)}, reach{gate, gate} {}

  float farthest() const { return std::max(reach[0], reach[1]); }

  /// Searches `voxel`, which is no nearer than `closest` [m^2].
  void add(const Voxel* voxel, float closest) {
    if (voxel == nullptr) return;
    for (std::size_t half = 0; half < kHalves; ++half) {
      if (closest <= reach[half]) add(voxel->halves[half], half);
    }
    voxels[count++] = voxel;
  }

  void add(const Half& points, std::size_t half) {
    const auto groups = static_cast<std::uint32_t>(points.count + 3) / 4;
    for (std::uint32_t group = 0; group < groups; ++group) {
      nearest[half].offer(points.points[group].squared_distances(query), count * kGroups + group);
    }
    reach[half] = nearest[half].reach();
  }

  Neighbors found(std::size_t half) const {
    std::array<NearestPoints::Found, NearestPoints::kWanted> ids;
    Neighbors neighbors;
    neighbors.count = static_cast<int>(nearest[half].sorted(ids));
    for (int k = 0; k < neighbors.count; ++k) {
      const auto [group, lane] = ids[static_cast<std::size_t>(k)];
      const Half& points = voxels[group / kGroups]->halves[half];
      neighbors.points[k] = points.point(static_cast<int>(4 * (group % kGroups) + lane));
      neighbors.squared_distances[k] = (neighbors.points[k] - query).squaredNorm();
    }
    return neighbors;
  }
};

/// The voxel of the query is searched first: only those within its reach are looked up, listed
/// without branches.
int VoxelMap::nearest(const Eigen::Vector3f& query,
                      std::array<Neighbors, kHalves>& neighbors) const {
  const VoxelIndex home = voxel_of(query, inverse_size_);
  const auto voxel_at = [&](const std::array<int, 3>& offset) {
    return voxels_.find(voxel_key({home.x + offset[0], home.y + offset[1], home.z + offset[2]}));
  };
  Search search(query, size_ * size_);
  search.add(voxel_at(kOffsets[0]), 0.0F);
  const std::array<float, 3> gap_x = squared_gaps(query.x(), home.x, size_);
  const std::array<float, 3> gap_y = squared_gaps(query.y(), home.y, size_);
  const std::array<float, 3> gap_z = squared_gaps(query.z(), home.z, size_);
  std::array<float, kNeighborhood> gaps;
  std::array<std::uint8_t, kNeighborhood> near;
  std::size_t count = 0;
  const float reach = search.farthest();
  for (std::size_t i = 1; i < kNeighborhood; ++i) {
    const auto& [dx, dy, dz] = kOffsets[i];
    gaps[i] = gap_x[dx + 1] + gap_y[dy + 1] + gap_z[dz + 1];
    near[count] = static_cast<std::uint8_t>(i);
    count += static_cast<std::size_t>(gaps[i] <= reach);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = near[k];
    if (gaps[i] <= search.farthest()) search.add(voxel_at(kOffsets[i]), gaps[i]);
  }
  for (std::size_t half = 0; half < kHalves; ++half) neighbors[half] = search.found(half);
  return static_cast<int>(search.count);
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
