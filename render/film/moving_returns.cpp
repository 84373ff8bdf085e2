// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/moving_returns.hpp"

#include <algorithm>

namespace aims {
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
