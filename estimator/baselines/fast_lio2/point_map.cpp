// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/point_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace aims::fast_lio2 {

namespace {

constexpr int kVoxelsPerCellLog2 = 2;  ///< along an edge

/// Shells of cells that are searched around a query before all points are: far from the map there
/// are more empty cells than points.
constexpr int kMaxShell = 6;

/// Allowance for the rounding of cell bounds, so that no cell is left out for it [-].
constexpr float kBoundFactor = 0.999F;

VoxelIndex voxel_index(const Eigen::Array3i& index) { return {index.x(), index.y(), index.z()}; }

/// Keeps the list sorted; drops the farthest beyond kNeighbours.
void insert(const Eigen::Vector3f& point, float squared_distance, Neighbours& found) {
  int at = found.count;
  if (at == kNeighbours) --at;
  const auto slot = [](int i) { return static_cast<std::size_t>(i); };
  for (; at > 0 && found.squared_distances[slot(at - 1)] > squared_distance; --at) {
    found.points[slot(at)] = found.points[slot(at - 1)];
    found.squared_distances[slot(at)] = found.squared_distances[slot(at - 1)];
  }
  found.points[slot(at)] = point;
  found.squared_distances[slot(at)] = squared_distance;
  found.count = std::min(found.count + 1, kNeighbours);
}

/// A point at this squared distance does not enter the list any more.
float worst(const Neighbours& found) {
  return found.count == kNeighbours ? found.squared_distances.back()
                                    : std::numeric_limits<float>::infinity();
}

/// Adds the points that are nearer than the farthest of the list.
void add_nearer(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3f& query,
                Neighbours& found) {
  for (const Eigen::Vector3f& point : points) {
    const float distance = (point - query).squaredNorm();
    if (distance < worst(found)) insert(point, distance, found);
  }
}

}  // namespace

PointMap::PointMap(double voxel)
    : voxel_(static_cast<float>(voxel)),
      cell_edge_(static_cast<float>(1 << kVoxelsPerCellLog2) * static_cast<float>(voxel)) {}

Eigen::Array3i PointMap::cell_index(const Eigen::Vector3f& point) const {
  // By the voxel, so that no voxel is in two cells; the quotient rounds towards minus infinity.
  return (point.array() / voxel_).floor().cast<int>().unaryExpr([](int voxel) {
    return voxel >> kVoxelsPerCellLog2;
  });
}

PointMap::Cell& PointMap::cell_of(const Eigen::Vector3f& point) {
  const Eigen::Array3i index = cell_index(point);
  const auto next = static_cast<std::int32_t>(cells_.size());
  if (next == 0) lowest_ = highest_ = index;
  lowest_ = lowest_.min(index);
  highest_ = highest_.max(index);
  const std::int32_t at = index_.find_or_insert(voxel_key(voxel_index(index)), next);
  if (at == next) cells_.emplace_back();
  return cells_[static_cast<std::size_t>(at)];
}

Eigen::Vector3f PointMap::voxel_centre(const Eigen::Vector3f& point) const {
  return (point.array() / voxel_).floor() * voxel_ + 0.5F * voxel_;
}

Box PointMap::voxel_box(const Eigen::Vector3f& point) const {
  Box box;
  box.min = (point.array() / voxel_).floor() * voxel_;
  box.max = box.min.array() + voxel_;
  return box;
}

void PointMap::add(const Eigen::Vector3f& point) {
  cell_of(point).push_back(point);
  ++size_;
}

void PointMap::add_to_voxel(const Eigen::Vector3f& point) {
  const Box box = voxel_box(point);
  const Eigen::Vector3f centre = 0.5F * (box.min + box.max);
  Cell& cell = cell_of(point);
  Eigen::Vector3f kept = point;
  float least = (point - centre).squaredNorm();
  std::size_t present = 0;
  for (const Eigen::Vector3f& other : cell) {
    if (!box.contains(other)) continue;
    ++present;
    const float distance = (other - centre).squaredNorm();
    if (distance < least) {
      least = distance;
      kept = other;
    }
  }
  if (present == 1 && kept != point) return;
  std::erase_if(cell, [&](const Eigen::Vector3f& other) { return box.contains(other); });
  cell.push_back(kept);
  size_ += 1 - present;
}

void PointMap::remove(const Box& box) {
  for (Cell& cell : cells_) {
    size_ -= std::erase_if(cell, [&](const Eigen::Vector3f& point) { return box.contains(point); });
  }
}

void PointMap::search_cell(const Eigen::Vector3f& query, const Eigen::Array3i& index,
                           Neighbours& found) const {
  const Eigen::Array3f low = index.cast<float>() * cell_edge_;
  const Eigen::Array3f outside =
      (low - query.array()).max(query.array() - low - cell_edge_).max(0.0F);
  if (kBoundFactor * outside.matrix().squaredNorm() >= worst(found)) return;
  const std::int32_t at = index_.find(voxel_key(voxel_index(index)));
  if (at == VoxelHash::kNone) return;
  add_nearer(cells_[static_cast<std::size_t>(at)], query, found);
}

void PointMap::search_shell(const Eigen::Vector3f& query, const Eigen::Array3i& centre, int radius,
                            Neighbours& found) const {
  const Eigen::Array3i low = (centre - radius).max(lowest_);
  const Eigen::Array3i high = (centre + radius).min(highest_);
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      const bool side = std::abs(x - centre.x()) == radius || std::abs(y - centre.y()) == radius;
      const int step = side || radius == 0 ? 1 : 2 * radius;
      for (int z = side ? low.z() : centre.z() - radius; z <= high.z(); z += step) {
        if (z >= low.z()) search_cell(query, {x, y, z}, found);
      }
    }
  }
}

/// Looks at every point.
Neighbours PointMap::nearest_of_all(const Eigen::Vector3f& query) const {
  Neighbours found;
  for (const Cell& cell : cells_) add_nearer(cell, query, found);
  return found;
}

Neighbours PointMap::nearest(const Eigen::Vector3f& query) const {
  const Eigen::Array3i centre = cell_index(query);
  const int last = (highest_ - centre).max(centre - lowest_).maxCoeff();
  const Eigen::Array3f low = centre.cast<float>() * cell_edge_;
  const float inside = (query.array() - low)
                           .min(low + cell_edge_ - query.array())
                           .minCoeff();  // to the nearest face
  Neighbours found;
  for (int radius = 0; radius <= std::min(last, kMaxShell); ++radius) {
    const float gap = inside + static_cast<float>(radius - 1) * cell_edge_;
    const bool done = radius > 0 && gap > 0.0F && kBoundFactor * gap * gap >= worst(found);
    if (done) return found;
    search_shell(query, centre, radius, found);
  }
  return last <= kMaxShell ? found : nearest_of_all(query);
}

std::vector<Eigen::Vector3f> PointMap::points() const {
  std::vector<Eigen::Vector3f> all;
  all.reserve(size_);
  for (const Cell& cell : cells_) all.insert(all.end(), cell.begin(), cell.end());
  return all;
}

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
