// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/voxel_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace aims {
namespace {

/// Steps along an axis from a voxel to those beside it; itself comes first.
constexpr std::array kSteps{0, -1, 1};

/// Squared distances along an axis from a point `at` in a voxel to the voxels after these steps
/// [m^2].
std::array<float, 3> squared_gaps(float at, std::int32_t voxel, float size) {
  const float inside = at - size * static_cast<float>(voxel);
  const float rest = size - inside;
  return {0.0F, inside * inside, rest * rest};
}

float smallest_of(Float4 a) { return std::min(std::min(a[0], a[1]), std::min(a[2], a[3])); }

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
        home_(map.voxels_.index_of(voxel_key(index_))) {
    const auto x = squared_gaps(point.x(), index_.x, map.size_);
    const auto y = squared_gaps(point.y(), index_.y, map.size_);
    const auto z = squared_gaps(point.z(), index_.z, map.size_);
    // The fourth place of each column is none.
    const Float4 column{z[0], z[1], z[2], std::numeric_limits<float>::infinity()};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) gaps_[3 * i + j] = (x[i] + y[j]) + column;
    }
  }

  /// Calls `visit(index)` for each voxel within reach() [m^2] of the point, its own first; reach()
  /// may shrink meanwhile.
  template <class Reach, class Visit>
  void visit(const Reach& reach, const Visit& visit) const {
    if (home_ != kNone) visit(home_);
    for (std::uint64_t places = places_within(reach()); places != 0; places &= places - 1) {
      const auto place = static_cast<std::size_t>(std::countr_zero(places));
      if (gaps_[place / 4][place % 4] > reach()) continue;
      const std::int32_t at = voxel(place);
      if (at != kNone) visit(at);
    }
  }

 private:
  /// Bit i: whether there may be a voxel at place i, within `reach`; without the first place.
  std::uint64_t places_within(float reach) const {
    std::uint64_t places = 0;
    for (std::size_t i = 0; i < gaps_.size(); ++i) {
      places |= static_cast<std::uint64_t>(lanes_of(gaps_[i] <= reach)) << (4 * i);
    }
    if (home_ != kNone) places &= map_.voxels_[home_].linked;
    return places & ~std::uint64_t{1};
  }

  std::int32_t voxel(std::size_t place) const {
    if (home_ != kNone) return map_.voxels_[home_].around[place];
    return map_.voxels_.index_of(voxel_key(neighbor(index_, place)));
  }

  const VoxelMap& map_;
  VoxelIndex index_;
  std::int32_t home_;
  std::array<Float4, kPlaces / 4> gaps_;  ///< squared distances to the voxels, by place [m^2]
};

/// The voxel at a place around another one.
VoxelIndex VoxelMap::neighbor(const VoxelIndex& voxel, std::size_t place) {
  return {voxel.x + kSteps[place / 12], voxel.y + kSteps[place / 4 % 3],
          voxel.z + kSteps[place % 4]};
}

/// The place of the voxel from which the one at `place` is seen: steps of -1 and 1 change.
std::size_t VoxelMap::opposite(std::size_t place) {
  constexpr std::array<std::size_t, 3> kBack{0, 2, 1};
  return 12 * kBack[place / 12] + 4 * kBack[place / 4 % 3] + kBack[place % 4];
}

/// Links a voxel with those around it, in both directions.
void VoxelMap::link(Voxel& voxel) {
  const std::int32_t at = voxels_.index_of(voxel.key);
  const VoxelIndex index = voxel_of(voxel.first, inverse_size_);
  voxel.linked = 0;
  for (std::size_t place = 0; place < kPlaces; ++place) {
    if (place % 4 == 3) continue;
    const std::int32_t other = voxels_.index_of(voxel_key(neighbor(index, place)));
    if (other == kNone) continue;
    voxel.link(place, other);
    voxels_[other].link(opposite(place), at);
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

/// Each lane keeps the nearest of its own, the first of those that are as near.
VoxelMap::Place VoxelMap::nearest_within_spacing(const Eigen::Vector3f& point) {
  Float4 nearest = Float4{} + spacing_ * spacing_;
  Int4 groups{};  // of these points, numbered over all voxels
  std::array<std::int32_t, kNeighborhood> voxels;
  std::int32_t count = 0;
  float reach = spacing_ * spacing_;
  const auto search = [&](std::int32_t at) {
    const Half& half = voxels_[at].halves[half_];
    for (std::int32_t group = 0; 4 * group < half.count; ++group) {
      const Float4 squared = half.points[static_cast<std::size_t>(group)].squared_distances(point);
      const Int4 nearer = squared < nearest;
      const auto id = count * static_cast<std::int32_t>(kGroups) + group;
      nearest = smaller(squared, nearest);
      groups = (groups & ~nearer) | (nearer & id);
    }
    reach = smallest_of(nearest);
    voxels[static_cast<std::size_t>(count++)] = at;
  };
  Surroundings(*this, point).visit([&] { return reach; }, search);
  if (reach >= spacing_ * spacing_) return {};
  unsigned lanes = lanes_of(nearest == Float4{} + reach);
  int first = std::countr_zero(lanes);
  for (lanes &= lanes - 1; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    if (groups[lane] < groups[first]) first = lane;
  }
  const auto id = static_cast<std::uint32_t>(groups[first]);
  return {voxels[id / kGroups], static_cast<int>(4 * (id % kGroups)) + first};
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
    reach = NearestPoints::reach(nearest[0], nearest[1]);
    voxels[count++] = &voxel;
  }

  /// The points of `half` that were found.
  Neighbors found(const NearestPoints::Sorted& sorted, std::size_t half) const {
    Neighbors neighbors;
    neighbors.count = static_cast<int>(sorted.count);
    for (std::size_t k = 0; k < sorted.count; ++k) {
      const auto [group, lane] = sorted.points[k];
      neighbors.points[k] =
          voxels[group / kGroups]->halves[half].points[group % kGroups].point(lane);
    }
    return neighbors;
  }
};

int VoxelMap::nearest(const Eigen::Vector3f& query,
                      std::array<Neighbors, kHalves>& neighbors) const {
  Search search(query, size_ * size_);
  Surroundings(*this, query)
      .visit([&] { return search.reach; }, [&](std::int32_t at) { search.add(voxels_[at]); });
  const auto sorted = NearestPoints::sorted(search.nearest[0], search.nearest[1]);
  for (std::size_t half = 0; half < kHalves; ++half) {
    neighbors[half] = search.found(sorted[half], half);
  }
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
