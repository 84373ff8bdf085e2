// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/scan_points.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace aims::fast_lio2 {
namespace {

/// Returns beyond this are no ranges of a LiDAR; indices of voxels stay small [m].
constexpr float kMaxRange = 1e4F;

/// The last knot before `stamp` that has another after it; none when there is none.
const Knot* knot_before(std::span<const Knot> knots, Time stamp) {
  if (knots.size() < 2 || stamp <= knots.front().stamp) return nullptr;
  const auto heads = knots.first(knots.size() - 1);
  return &*std::prev(std::ranges::lower_bound(heads, stamp, {}, &Knot::stamp));
}

}  // namespace

std::vector<int> selected_points(const LidarScan& scan, const Points& config) {
  std::vector<int> indices;
  const auto step = static_cast<std::size_t>(config.every_nth);
  const auto nearest = static_cast<float>(config.min_range);
  for (std::size_t i = 0; i < scan.points.size(); i += step) {
    const float range = scan.points[i].position.norm();
    if (range > nearest && range < kMaxRange) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

Time end_of(const LidarScan& scan, std::span<const int> indices) {
  if (indices.empty()) return scan.end;
  const Duration last = scan.points[static_cast<std::size_t>(indices.back())].time_offset_ns;
  return last < (scan.end - scan.stamp) / 2 ? scan.end : scan.stamp + last;
}

std::vector<Eigen::Vector3f> deskewed(const LidarScan& scan, std::span<const int> indices,
                                      std::span<const Knot> knots, const State& end) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(indices.size());
  const Pose T_end_world = end.T_world_body.inverse();
  const Pose T_lidar_body = end.T_body_lidar.inverse();
  for (int index : indices) {
    const LidarPoint& point = scan.points[static_cast<std::size_t>(index)];
    const Time stamp = scan.stamp + point.time_offset_ns;
    const Knot* knot = knot_before(knots, stamp);
    if (knot == nullptr) {
      points.push_back(point.position);
      continue;
    }
    const Knot& next = knot[1];
    const double dt = to_seconds(stamp - knot->stamp);
    const Pose T_world_body{
        knot->T_world_body.rotation * so3_exp(dt * next.rate),
        knot->T_world_body.translation + dt * knot->velocity + 0.5 * dt * dt * next.acceleration};
    const Eigen::Vector3d p_world =
        T_world_body * (end.T_body_lidar * point.position.cast<double>());
    points.push_back((T_lidar_body * (T_end_world * p_world)).cast<float>());
  }
  return points;
}

std::vector<Eigen::Vector3f> voxel_centroids(std::span<const Eigen::Vector3f> points,
                                             double voxel) {
  struct Entry {
    std::tuple<int, int, int> key;  ///< z, y, x
    int index = 0;
  };
  const auto inverse = static_cast<float>(1.0 / voxel);
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Array3i at = (points[i].array() * inverse).floor().cast<int>();
    entries.push_back({{at.z(), at.y(), at.x()}, static_cast<int>(i)});
  }
  std::ranges::stable_sort(entries, {}, &Entry::key);
  std::vector<Eigen::Vector3f> centroids;
  for (std::size_t begin = 0; begin < entries.size();) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    std::size_t end = begin;
    for (; end < entries.size() && entries[end].key == entries[begin].key; ++end) {
      sum += points[static_cast<std::size_t>(entries[end].index)];
    }
    centroids.push_back(sum / static_cast<float>(end - begin));
    begin = end;
  }
  return centroids;
}

}  // namespace aims::fast_lio2
