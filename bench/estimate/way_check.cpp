// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/way_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "core/lie.hpp"

namespace aims {
namespace {

constexpr Duration kWindow = kSecond;
constexpr Duration kMostGap = 2 * kWindow;
constexpr double kWalking = 0.15;         ///< of the legs [m/s]
constexpr Duration kSurely = kSecond;     ///< so long
constexpr Duration kPause = kSecond / 2;  ///< that ends a walk
constexpr int kMostScans = 60;
constexpr int kFewestWindows = 3;
constexpr double kLeastWay = 0.15;  ///< of a window by the legs [m]
constexpr double kMostTurn = 0.3;   ///< of a window [rad]
constexpr double kLeastSeen = 0.5;  ///< of the way of the legs that LiDAR odometry has to see
constexpr double kOpposite = -0.7;  ///< cosine between the ways

/// Ways over a window, in body axes [m].
struct Ways {
  Eigen::Vector3d lidar = Eigen::Vector3d::Zero(), legs = Eigen::Vector3d::Zero();
};

/// The way by the velocities of the legs; nothing with few samples.
std::optional<Eigen::Vector3d> way_of(std::span<const LegOdometrySample> legs, Time begin,
                                      Time end) {
  constexpr int kFewest = 5;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const LegOdometrySample& each : legs) {
    if (each.stamp < begin || each.stamp > end || !each.linear_velocity.allFinite()) continue;
    sum += each.linear_velocity;
    ++count;
  }
  if (count < kFewest) return std::nullopt;
  return sum / count * to_seconds(end - begin);
}

std::vector<Ways> ways_of(const Trajectory& path, std::span<const LegOdometrySample> legs,
                          const SensorRig& rig) {
  std::vector<Ways> found;
  std::size_t first = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Duration step = path[i].stamp - path[first].stamp;
    if (step < kWindow) continue;
    const Pose moved = path[first].pose.inverse() * path[i].pose;
    const auto by_legs = way_of(legs, path[first].stamp, path[i].stamp);
    const bool straight = so3_log(moved.rotation).norm() < kMostTurn;
    if (by_legs && straight && step < kMostGap && by_legs->norm() > kLeastWay) {
      found.push_back(
          {rig.T_body_lidar.rotation * moved.translation, rig.T_body_base.rotation * *by_legs});
    }
    first = i;
  }
  return found;
}

}  // namespace

std::optional<ReadingWarning> check_way(std::span<const Trajectory> paths,
                                        std::span<const LegOdometrySample> legs,
                                        const SensorRig& rig) {
  int windows = 0, opposite = 0;
  double by_legs = 0.0, by_lidar = 0.0;
  for (const Trajectory& path : paths) {
    for (const Ways& each : ways_of(path, legs, rig)) {
      const double lidar = each.lidar.norm(), way = each.legs.norm();
      if (lidar < kLeastSeen * way) continue;
      ++windows;
      if (each.lidar.dot(each.legs) > kOpposite * lidar * way) continue;
      ++opposite;
      by_legs += way;
      by_lidar += lidar;
    }
  }
  if (opposite < kFewestWindows || 4 * opposite < 3 * windows) return std::nullopt;
  return ReadingWarning{
      "legs walk opposite to LiDAR odometry",
      fmt::format("in {} of {} seconds that were compared the legs go the opposite way of LiDAR "
                  "odometry ({:.2f} m, {:.2f} m): legs are exchanged (joint_names, foot_names), "
                  "joints have another sign, or legs or LiDAR are mounted the other way round "
                  "(T_imu_base, T_imu_lidar)",
                  opposite, windows, by_legs, by_lidar),
      WarnedSensor::kLegs};
}

WayCheck::WayCheck(const RecordingSetup& setup) : rig_(setup.rig) {
  const std::string& lidar = setup.topics.lidar;
  wanted_ = setup.has_legs && !lidar.empty() && lidar != "none";
}

void WayCheck::take(const LegOdometrySample& sample) {
  const bool walks = sample.linear_velocity.norm() > kWalking;
  if (walks && (!last_walk_ || sample.stamp - *last_walk_ > kPause)) walking_since_ = sample.stamp;
  if (walks) last_walk_ = sample.stamp;
  if (last_walk_) legs_.push_back(sample);
}

void WayCheck::consume(std::span<const Delivery> deliveries) {
  for (const Delivery& each : deliveries) {
    if (!wanted_) return;
    if (const auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) take(*legs);
    const auto* scan = std::get_if<LidarScanPtr>(&each.measurement);
    if (scan == nullptr || !walking_since_ || (*scan)->stamp < *walking_since_ + kSurely) continue;
    if ((*scan)->stamp > *last_walk_ + kPause) continue;
    odometry_.add(**scan);
    wanted_ = ++scans_ < kMostScans;
  }
}

std::optional<ReadingWarning> WayCheck::warning() const {
  return check_way(odometry_.paths(), legs_, rig_);
}

}  // namespace aims
