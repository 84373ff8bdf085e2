// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/scan_points.hpp"

#include <algorithm>

namespace aims::bievr {
namespace {

struct Knot {
  Time stamp = 0;
  Pose T_world_body;
};

/// Poses at the begin and at the end of each segment.
std::vector<Knot> knots_of(const NavState& from, const std::vector<InertialSegment>& segments,
                           const InertialState& x) {
  std::vector<Knot> knots = {{segments.front().begin, from.T_map_imu}};
  Preintegration motion;
  motion.bias = x.bias;
  for (const InertialSegment& segment : segments) {
    lio_sam::integrate(motion, segment.angular_velocity, segment.specific_force,
                       to_seconds(segment.end - segment.begin), lio_sam::ImuNoiseConfig());
    knots.push_back({segment.end, predicted(from, motion, x).T_map_imu});
  }
  return knots;
}

Pose pose_at(const std::vector<Knot>& knots, Time stamp) {
  const auto after = std::ranges::lower_bound(knots, stamp, {}, &Knot::stamp);
  if (after == knots.begin()) return knots.front().T_world_body;
  if (after == knots.end()) return knots.back().T_world_body;
  const Knot& before = *std::prev(after);
  const double fraction =
      to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp);
  return interpolate(before.T_world_body, after->T_world_body, fraction);
}

}  // namespace

TimedPoints points_in_range(const LidarScan& scan, const Pose& T_body_lidar, const Points& config) {
  const Eigen::Matrix3d R = T_body_lidar.R();
  TimedPoints result;
  result.points.reserve(scan.points.size());
  result.stamps.reserve(scan.points.size());
  for (const LidarPoint& point : scan.points) {
    const auto range = static_cast<double>(point.position.norm());
    if (!(range >= config.min_range && range <= config.max_range)) continue;
    result.points.emplace_back(R * point.position.cast<double>() + T_body_lidar.translation);
    result.stamps.push_back(scan.stamp + point.time_offset_ns);
  }
  return result;
}

std::vector<Eigen::Vector3d> deskewed(const TimedPoints& scan, const NavState& from,
                                      const std::vector<InertialSegment>& segments,
                                      const InertialState& x) {
  if (segments.empty()) return scan.points;
  const std::vector<Knot> knots = knots_of(from, segments, x);
  const Pose T_end_world = knots.back().T_world_body.inverse();
  std::vector<Eigen::Vector3d> points;
  points.reserve(scan.points.size());
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (i == 0 || scan.stamps[i] != scan.stamps[i - 1]) {  // the rings of a column fire together
      const Pose T_end_now = T_end_world * pose_at(knots, scan.stamps[i]);
      R = T_end_now.R();
      t = T_end_now.translation;
    }
    points.emplace_back(R * scan.points[i] + t);
  }
  return points;
}

}  // namespace aims::bievr
