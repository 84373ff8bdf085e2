// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/range_residuals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/environment/people.hpp"

namespace aims {
namespace {

constexpr double kFarResidual = 0.1;  ///< beyond it a return is no noise [m]
constexpr std::array kRangeLimits = {0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};
constexpr std::array kIncidenceLimits = {0.0, 30.0, 60.0, 75.0, 85.0, 90.0};  ///< [deg]

Pose held_pose_at(const Trajectory& trajectory, Time stamp) {
  if (stamp <= trajectory.front().stamp) return trajectory.front().pose;
  return pose_at(trajectory, stamp).value_or(trajectory.back().pose);
}

/// The rays of up to sixteen points from `first` on.
int aim_at(const LidarScan& scan, std::size_t first, const Trajectory& T_world_lidar,
           RayPacket& rays, std::array<Time, kRayPacketSize>& stamps) {
  const auto count =
      static_cast<int>(std::min<std::size_t>(kRayPacketSize, scan.points.size() - first));
  stamps.fill(scan.stamp);
  for (int lane = 0; lane < count; ++lane) {
    const LidarPoint& point = scan.points[first + static_cast<std::size_t>(lane)];
    stamps[lane] = scan.stamp + point.time_offset_ns;
    const Pose pose = held_pose_at(T_world_lidar, stamps[lane]);
    const Eigen::Vector3d towards = pose.rotation * point.position.cast<double>().normalized();
    rays.origin_x[lane] = static_cast<float>(pose.translation.x());
    rays.origin_y[lane] = static_cast<float>(pose.translation.y());
    rays.origin_z[lane] = static_cast<float>(pose.translation.z());
    rays.direction_x[lane] = static_cast<float>(towards.x());
    rays.direction_y[lane] = static_cast<float>(towards.y());
    rays.direction_z[lane] = static_cast<float>(towards.z());
  }
  return count;
}

RangeResidual residual_of(const LidarPoint& point, const RayPacket& rays, const HitPacket& hits,
                          int lane) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (hits.surface[lane] < 0) return {kInfinity, 0.0, -kInfinity};
  const double cosine = -(hits.normal_x[lane] * rays.direction_x[lane] +
                          hits.normal_y[lane] * rays.direction_y[lane] +
                          hits.normal_z[lane] * rays.direction_z[lane]);
  const double range = hits.distance[lane];
  return {range, cosine, point.position.cast<double>().norm() - range};
}

bool in_bin(const ResidualBin& bin, const RangeResidual& each) {
  const double incidence = std::acos(std::clamp(each.cosine, 0.0, 1.0)) * 180.0 / std::numbers::pi;
  return each.range >= bin.range_begin && each.range < bin.range_end &&
         incidence >= bin.incidence_begin_deg && incidence < bin.incidence_end_deg;
}

void fill(ResidualBin& bin, const std::vector<RangeResidual>& residuals) {
  int near = 0;
  double sum = 0.0;
  double squares = 0.0;
  for (const RangeResidual& each : residuals) {
    if (!in_bin(bin, each)) continue;
    ++bin.returns;
    if (std::abs(each.residual) > kFarResidual) continue;
    ++near;
    sum += each.residual;
    squares += each.residual * each.residual;
  }
  if (bin.returns == 0) return;
  bin.share_beyond = 1.0 - static_cast<double>(near) / bin.returns;
  if (near == 0) return;
  bin.mean = sum / near;
  bin.std = std::sqrt(std::max(squares / near - bin.mean * bin.mean, 0.0));
}

}  // namespace

std::vector<RangeResidual> range_residuals(const LidarScan& scan, const Trajectory& T_world_lidar,
                                           const RayCaster& caster) {
  std::vector<RangeResidual> residuals;
  residuals.reserve(scan.points.size());
  constexpr float kReach = 1e4F;  // [m]
  RayPacket rays;
  HitPacket hits;
  std::array<Time, kRayPacketSize> stamps;
  for (std::size_t first = 0; first < scan.points.size(); first += kRayPacketSize) {
    const int count = aim_at(scan, first, T_world_lidar, rays, stamps);
    caster.cast(rays, kReach, hits, count);
    intersect_people(caster.people(), rays, stamps, caster.first_moving_surface(), kReach, hits);
    for (int lane = 0; lane < count; ++lane) {
      const LidarPoint& point = scan.points[first + static_cast<std::size_t>(lane)];
      residuals.push_back(residual_of(point, rays, hits, lane));
    }
  }
  return residuals;
}

std::vector<ResidualBin> residual_bins(const std::vector<RangeResidual>& residuals) {
  std::vector<ResidualBin> bins;
  for (std::size_t r = 0; r + 1 < kRangeLimits.size(); ++r) {
    for (std::size_t i = 0; i + 1 < kIncidenceLimits.size(); ++i) {
      ResidualBin bin{.range_begin = kRangeLimits[r],
                      .range_end = kRangeLimits[r + 1],
                      .incidence_begin_deg = kIncidenceLimits[i],
                      .incidence_end_deg = kIncidenceLimits[i + 1]};
      fill(bin, residuals);
      if (bin.returns > 0) bins.push_back(bin);
    }
  }
  return bins;
}

}  // namespace aims
