// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/map_growth.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace aims {

namespace {

/// The pose of a moving sensor, looked up again after this time.
constexpr Duration kSamePose = 2 * kMillisecond;

}  // namespace

MapGrowth::MapGrowth(const Pose& T_body_lidar, const MapGrowthConfig& config)
    : T_body_lidar_(T_body_lidar), config_(config) {}

void MapGrowth::add(const LidarScanPtr& scan, std::vector<bool> moving) {
  if (scans_++ % config_.every_scan == 0) waiting_.push_back({scan, std::move(moving)});
}

void MapGrowth::settle(const Trajectory& trajectory) {
  while (!waiting_.empty() && !trajectory.empty() &&
         waiting_.front().scan->end <= trajectory.back().stamp) {
    insert(waiting_.front(), trajectory);
    waiting_.pop_front();
  }
}

void MapGrowth::insert(const Waiting& each, const Trajectory& trajectory) {
  const LidarScan& scan = *each.scan;
  PlacedScan& placed = placed_.emplace_back(PlacedScan{scan.end, {}});
  const std::size_t step = scan.points.size() / static_cast<std::size_t>(config_.scan_returns) + 1;
  std::optional<Pose> T_odom_lidar;
  Time looked_up = scan.stamp - kSecond;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const LidarPoint& point = scan.points[i];
    const Time fired = scan.stamp + point.time_offset_ns;
    if (std::abs(fired - looked_up) >= kSamePose) {
      looked_up = fired;
      T_odom_lidar = pose_at(trajectory, fired);
      if (T_odom_lidar) *T_odom_lidar = *T_odom_lidar * T_body_lidar_;
    }
    if (!T_odom_lidar || !point.position.allFinite()) continue;
    if (point.position.norm() > config_.reach) continue;
    const Eigen::Vector3f position = (*T_odom_lidar * point.position.cast<double>()).cast<float>();
    if (!position.allFinite() || position.norm() > 1e4F) continue;  // of an estimator that diverged
    if (i % step == 0) placed.points.push_back(position);
    if (!each.moving.empty() && each.moving[i]) continue;
    const auto fresh = static_cast<std::int32_t>(points_.size());
    const std::uint64_t cube = voxel_key(voxel_of(position, 1.0F / config_.spacing));
    if (cubes_.find_or_insert(cube, fresh) != fresh) continue;
    points_.push_back({position, fired});
  }
}

namespace {

/// Returns so near to a person's surface are theirs, whatever noise they have [m].
constexpr double kPersonMargin = 0.15;
constexpr double kFloorMargin = 0.04;  ///< below this height they may be the floor's [m]

bool is_of(const Person& person, const Eigen::Vector3d& p_world, Time fired) {
  const double away = (p_world.head<2>() - person.position(fired)).norm();
  return away <= person.radius + kPersonMargin && p_world.z() > kFloorMargin &&
         p_world.z() <= person.height + kPersonMargin;
}

}  // namespace

std::vector<bool> moving_returns(const LidarScan& scan, const Scene& scene, const Trajectory& truth,
                                 const Pose& T_body_lidar) {
  if (scene.people.empty()) return {};
  std::vector<bool> moving;
  moving.reserve(scan.points.size());
  for (const LidarPoint& point : scan.points) {
    const Time fired = scan.stamp + point.time_offset_ns;
    const auto T_world_body = pose_at(truth, fired);
    const auto hit = [&](const Person& person) {
      return is_of(person, *T_world_body * (T_body_lidar * point.position.cast<double>()), fired);
    };
    moving.push_back(T_world_body && std::ranges::any_of(scene.people, hit));
  }
  return moving;
}

}  // namespace aims
