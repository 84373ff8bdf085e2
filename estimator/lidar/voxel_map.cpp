// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/voxel_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace aims {
namespace {

/// Places before, at and after a voxel along an axis, and the squared distances of a point in it to
/// the voxels there [m^2]; the voxel itself comes first.
struct Steps {
  std::array<int, 3> offsets{0, -1, 1};
  std::array<float, 3> gaps{};

  Steps(float at, std::int32_t home, float size) {
    const float inside = at - size * static_cast<float>(home);
    const float rest = size - inside;
    gaps = {0.0F, inside * inside, rest * rest};
  }
};

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
    if (point.allFinite()) insert(point, covariance);
  }
  end_insertion();
  const bool dropped = voxels_.limit(
      max_voxels_, [&center](const Voxel& v) { return (v.first - center).squaredNorm(); });
  if (!dropped) return;
  for (Voxel& voxel : voxels_) link(voxel);
}

/// The voxels at and around a point: those around it by the links of the one that it lies in.
class VoxelMap::Surroundings {
 public:
  Surroundings(const VoxelMap& map, const Eigen::Vector3f& point)
      : map_(map),
        index_(voxel_of(point, map.inverse_size_)),
        steps_{Steps(point.x(), index_.x, map.size_), Steps(point.y(), index_.y, map.size_),
               Steps(point.z(), index_.z, map.size_)},
        home_(map.voxels_.index_of(voxel_key(index_))) {}

  /// Calls `visit(index)` for each voxel within reach() [m^2] of the point, its own first; reach()
  /// may shrink meanwhile.
  template <class Reach, class Visit>
  void visit(const Reach& reach, const Visit& visit) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (steps_[0].gaps[i] > reach()) continue;
      for (std::size_t j = 0; j < 3; ++j) {
        if (steps_[0].gaps[i] + steps_[1].gaps[j] > reach()) continue;
        for (std::size_t k = 0; k < 3; ++k) {
          const float gap = steps_[0].gaps[i] + steps_[1].gaps[j] + steps_[2].gaps[k];
          if (gap > reach()) continue;
          const std::int32_t at =
              voxel(steps_[0].offsets[i], steps_[1].offsets[j], steps_[2].offsets[k]);
          if (at != kNone) visit(at);
        }
      }
    }
  }

 private:
  std::int32_t voxel(int dx, int dy, int dz) const {
    if (home_ != kNone) return map_.voxels_[home_].around[place_of(dx, dy, dz)];
    return map_.voxels_.index_of(voxel_key({index_.x + dx, index_.y + dy, index_.z + dz}));
  }

  const VoxelMap& map_;
  VoxelIndex index_;
  std::array<Steps, 3> steps_;
  std::int32_t home_;
};

std::size_t VoxelMap::place_of(int dx, int dy, int dz) {
  return static_cast<std::size_t>(9 * (dx + 1) + 3 * (dy + 1) + dz + 1);
}

/// Links a voxel with those around it, in both directions.
void VoxelMap::link(Voxel& voxel) {
  const std::int32_t at = voxels_.index_of(voxel.key);
  const VoxelIndex index = voxel_of(voxel.first, inverse_size_);
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const std::int32_t other =
            voxels_.index_of(voxel_key({index.x + dx, index.y + dy, index.z + dz}));
        voxel.around[place_of(dx, dy, dz)] = other;
        if (other != kNone) voxels_[other].around[place_of(-dx, -dy, -dz)] = at;
      }
    }
  }
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
  return fit_planes({neighbors[0].points, neighbors[1].points}, query);
}

/// A return merges into the nearest map point within the spacing, on whichever side of a border
/// between voxels: a wall along a border would otherwise get a second layer, of the returns that
/// noise pushes across it, and its mean would lie off.
void VoxelMap::insert(const Eigen::Vector3f& point, const Eigen::Matrix3f& covariance) {
  const Place nearest = nearest_within_spacing(point);
  if (nearest.voxel == kNone) {
    add(point, 1, covariance);
  } else if (voxels_[nearest.voxel].halves[half_].merged[nearest.point] < kMaxMerges) {
    merge(point, nearest, covariance);
  }
}

VoxelMap::Place VoxelMap::nearest_within_spacing(const Eigen::Vector3f& point) {
  Place place;
  float nearest = spacing_ * spacing_;
  const auto search = [&](std::int32_t at) {
    const Half& half = voxels_[at].halves[half_];
    for (int begin = 0; begin < half.count; begin += 4) {
      const Float4 squared =
          half.points[static_cast<std::size_t>(begin / 4)].squared_distances(point);
      for (unsigned lanes = lanes_of(squared < nearest); lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        if (squared[lane] >= nearest) continue;
        nearest = squared[lane];
        place = {at, begin + lane};
      }
    }
  };
  Surroundings(*this, point).visit([&] { return nearest; }, search);
  return place;
}

/// A mean that crosses a border goes over to the voxel that it then lies in.
void VoxelMap::merge(const Eigen::Vector3f& point, const Place& into,
                     const Eigen::Matrix3f& covariance) {
  Voxel& voxel = voxels_[into.voxel];
  Half& half = voxel.halves[half_];
  const std::uint8_t merged = ++half.merged[into.point];
  const Eigen::Vector3f before = half.point(into.point);
  const Eigen::Vector3f mean = before + (point - before) / static_cast<float>(merged);
  if (voxel_key(voxel_of(mean, inverse_size_)) == voxel.key) {
    half.set(into.point, mean);
  } else {
    half.remove(into.point);
    add(mean, merged, covariance);
  }
}

/// Adds a map point that `merged` returns were averaged to, where there is room.
void VoxelMap::add(const Eigen::Vector3f& point, std::uint8_t merged,
                   const Eigen::Matrix3f& covariance) {
  Voxel& voxel = voxels_.touch(voxel_key(voxel_of(point, inverse_size_)));
  if (voxel.empty) {
    voxel.empty = false;
    voxel.first = point;
    voxel.covariance = covariance;
    link(voxel);
  }
  Half& half = voxel.halves[half_];
  if (half.count == kCapacity) return;
  half.merged[half.count] = merged;
  half.set(half.count++, point);
}

Eigen::Vector3f VoxelMap::Half::point(int i) const {
  const auto at = static_cast<std::size_t>(i);
  return points[at / 4].point(at % 4);
}

void VoxelMap::Half::set(int i, const Eigen::Vector3f& point) {
  const auto at = static_cast<std::size_t>(i);
  points[at / 4].set(at % 4, point);
}

/// The last point takes its place.
void VoxelMap::Half::remove(int i) {
  set(i, point(--count));
  merged[i] = merged[count];
  set(count, Eigen::Vector3f::Constant(kFar));
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
  float reach;  ///< farther points have no effect [m^2]
  std::array<const Voxel*, kNeighborhood> voxels;
  std::uint32_t count = 0;

  Search(const Eigen::Vector3f& point, float gate)
      : query(point), nearest{NearestPoints(gate), NearestPoints(gate)}, reach(gate) {}

  /// Searches both halves of `voxel`.
  void add(const Voxel& voxel) {
    const auto& [a, b] = voxel.halves;
    const auto groups = static_cast<std::uint32_t>(std::max(a.count, b.count) + 3) / 4;
    for (std::uint32_t group = 0; group < groups; ++group) {
      const std::uint32_t id = count * kGroups + group;
      nearest[0].offer(a.points[group].squared_distances(query), id);
      nearest[1].offer(b.points[group].squared_distances(query), id);
    }
    reach = std::max(nearest[0].reach(), nearest[1].reach());
    voxels[count++] = &voxel;
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

int VoxelMap::nearest(const Eigen::Vector3f& query,
                      std::array<Neighbors, kHalves>& neighbors) const {
  Search search(query, size_ * size_);
  Surroundings(*this, query)
      .visit([&] { return search.reach; }, [&](std::int32_t at) { search.add(voxels_[at]); });
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
