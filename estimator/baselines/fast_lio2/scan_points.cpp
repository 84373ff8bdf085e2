// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/scan_points.hpp"

#include <algorithm>

#include "estimator/lidar/point_choice.hpp"

namespace aims::fast_lio2 {
namespace {

/// The last knot before `stamp` that has another after it; none when there is none.
const Knot* knot_before(std::span<const Knot> knots, Time stamp) {
  if (knots.size() < 2 || stamp <= knots.front().stamp) return nullptr;
  const auto heads = knots.first(knots.size() - 1);
  return &*std::prev(std::ranges::lower_bound(heads, stamp, {}, &Knot::stamp));
}

}  // namespace

std::vector<int> selected_points(const LidarScan& scan, const Points& config) {
  return chosen_points(scan, config.every_nth, config.min_range);
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

}  // namespace aims::fast_lio2
