// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/mapping.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/lie.hpp"

namespace aims::lio_sam {

namespace {

/// Attitudes with a greater pitch are not used [rad].
constexpr double kSteepPitch = 1.4;

}  // namespace

RollPitchYaw angles_of(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d R = rotation.toRotationMatrix();
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

Eigen::Quaterniond rotation_of(const RollPitchYaw& angles) {
  return Eigen::AngleAxisd(angles.yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.roll, Eigen::Vector3d::UnitX());
}

Eigen::Quaterniond levelled(const Eigen::Quaterniond& rotation, const RollPitchYaw& attitude,
                            double weight) {
  if (std::abs(attitude.pitch) >= kSteepPitch) return rotation;
  RollPitchYaw angles = angles_of(rotation);
  angles.roll += weight * wrap_angle(attitude.roll - angles.roll);
  angles.pitch += weight * wrap_angle(attitude.pitch - angles.pitch);
  return rotation_of(angles);
}

namespace {

/// Farther from the start a pose is of no use, and indices of voxels would overflow [m].
constexpr double kMaxDistance = 5e4;

bool is_usable(const Pose& pose) {
  return pose.rotation.coeffs().allFinite() && pose.translation.allFinite() &&
         pose.translation.norm() < kMaxDistance;
}

}  // namespace

features::SolverConfig solver_config() {
  features::SolverConfig config = features::map_solver_config();
  config.max_iterations = 30;
  return config;
}

void describe(Fields& f, MappingConfig& c) {
  f.number("min_interval", c.min_interval,
           {"s", in_range(0.0, 100.0), "between two scans that are registered",
            "mappingProcessInterval"});
  f.integer("min_scan_edges", c.min_scan_edges,
            {"-", in_range(0, 1000000), "a scan needs more edges to be registered"});
  f.integer("min_scan_surface", c.min_scan_surface,
            {"-", in_range(0, 1000000), "a scan needs more surface points to be registered"});
  f.number(
      "edge_voxel", c.edge_voxel,
      {"m", in_range(0.01, 10.0), "edges are averaged in such voxels", "mappingCornerLeafSize"});
  f.number("surface_voxel", c.surface_voxel,
           {"m", in_range(0.01, 10.0), "surface points are averaged in such voxels",
            "mappingSurfLeafSize"});
  f.number("keyframe_distance", c.keyframe_distance,
           {"m", up_to(1e4), "a scan this far from the last keyframe becomes one"});
  f.number("keyframe_angle", c.keyframe_angle,
           {"rad", in_range(0.0, 4.0), "or this far in roll, pitch or yaw"});
  f.number("submap_radius", c.submap_radius,
           {"m", positive_up_to(1e4), "keyframes nearer to the last one make the map"});
  f.number("keyframe_voxel", c.keyframe_voxel,
           {"m", in_range(0.01, 1e3), "one keyframe is used per voxel of their positions"});
  f.number("recent", c.recent, {"s", up_to(1e4), "younger keyframes are used, too"});
  f.number("attitude_weight", c.attitude_weight,
           {"-", in_range(0.0, 1.0), "of the IMU's roll and pitch in the pose", "imuRPYWeight"});
  f.number("odometry_weight", c.odometry_weight,
           {"-", in_range(0.0, 1.0),
            "of the IMU's roll and pitch in the pose that the IMU odometry is given"});
  f.group("matching", c.matching);
  f.group("solver", c.solver);
  f.group("graph", c.graph);
  f.group("loop", c.loop);
}

Mapping::Mapping(const MappingConfig& config)
    : config_(config), keyframes_(config.graph, config.loop) {}

bool Mapping::is_due(Time stamp) const {
  return !last_stamp_ || stamp - *last_stamp_ >= from_seconds(config_.min_interval);
}

/// The pose before the scan, moved as the IMU odometry has moved since it was last known, else
/// turned as the attitude. Where the odometry was missing for a while, its motion counts twice, as
/// in the published program.
void Mapping::guess(const ScanPrior& prior) {
  before_ = pose_;
  const Eigen::Quaterniond attitude = rotation_of(prior.attitude);
  if (map().empty()) {
    pose_.rotation = attitude;
    last_attitude_ = attitude;
    return;
  }
  if (prior.odometry) {
    const std::optional<Pose> last = std::exchange(last_odometry_, prior.odometry);
    if (last) {
      pose_ = pose_ * last->inverse() * *prior.odometry;
      pose_.rotation.normalize();
      last_attitude_ = attitude;
      return;
    }
  }
  if (prior.imu_available) guess_from_rotation(attitude);
}

void Mapping::guess_from_rotation(const Eigen::Quaterniond& attitude) {
  pose_.rotation = (pose_.rotation * last_attitude_.conjugate() * attitude).normalized();
  last_attitude_ = attitude;
}

/// The keyframes near the last one. Recent ones among them count twice, as in the published
/// program.
void Mapping::build_submap(Time stamp) {
  const Eigen::Vector3d last = map().last_pose().translation;
  std::vector<int> indices = map().near_means(last, config_.submap_radius, config_.keyframe_voxel);
  for (int i = map().size() - 1; i >= 0; --i) {
    if (to_seconds(stamp - map()[i].stamp) >= config_.recent) break;
    indices.push_back(i);
  }
  std::erase_if(indices, [&](int i) {
    return (map()[i].T_map_lidar.translation - last).norm() > config_.submap_radius;
  });
  if (indices == submap_) return;
  const features::KeyframeMap::Submap submap = map().submap(indices);
  reference_.build(positions_of(voxel_centroids(submap.edges, config_.edge_voxel)),
                   positions_of(voxel_centroids(submap.planes, config_.surface_voxel)));
  submap_ = std::move(indices);
}

/// False when the result is of no use.
bool Mapping::register_scan(const features::FeatureCloud& edges,
                            const features::FeatureCloud& surface, const ScanPrior& prior,
                            RegisteredScan& result) {
  const auto associate = [&](const Pose& T_map_lidar) {
    return reference_.match(edges, surface, T_map_lidar, config_.matching);
  };
  result.solver = features::solve_pose(pose_, associate, config_.solver);
  if (!is_usable(result.solver.pose)) return false;
  if (result.solver.iterations > 0) degenerate_ = result.solver.directions.removed > 0;
  pose_ = result.solver.pose;
  if (prior.imu_available) {
    pose_.rotation = levelled(pose_.rotation, prior.attitude, config_.attitude_weight);
  }
  registered_ = pose_;
  return true;
}

bool Mapping::is_keyframe() const {
  if (map().empty()) return true;
  const Pose moved = map().last_pose().inverse() * pose_;
  const RollPitchYaw angles = angles_of(moved.rotation);
  const double angle =
      std::max({std::abs(angles.roll), std::abs(angles.pitch), std::abs(angles.yaw)});
  return angle >= config_.keyframe_angle || moved.translation.norm() >= config_.keyframe_distance;
}

void Mapping::add_keyframe(Time stamp, features::FeatureCloud edges,
                           features::FeatureCloud surface) {
  const bool moved = keyframes_.add({pose_, std::move(edges), std::move(surface), stamp});
  pose_ = map().last_pose();
  if (moved) submap_.clear();
}

/// The pose whose increments leave out corrections by loops, with more of the IMU's attitude.
LidarOdometry Mapping::odometry(Time stamp, const ScanPrior& prior) {
  if (!incremental_) {
    incremental_ = pose_;
    return {stamp, pose_, false};
  }
  *incremental_ = *incremental_ * before_.inverse() * registered_;
  incremental_->rotation.normalize();
  LidarOdometry result{stamp, *incremental_, degenerate_};
  if (prior.imu_available) {
    result.T_map_lidar.rotation =
        levelled(incremental_->rotation, prior.attitude, config_.odometry_weight);
  }
  return result;
}

RegisteredScan Mapping::update(Time stamp, const ScanFeatures& scan, const ScanPrior& prior) {
  last_stamp_ = stamp;
  RegisteredScan result;
  auto edges = voxel_centroids(scan.edges, config_.edge_voxel);
  auto surface = voxel_centroids(scan.surface, config_.surface_voxel);
  result.edges = static_cast<int>(edges.size());
  result.surface = static_cast<int>(surface.size());
  guess(prior);
  if (!is_usable(pose_)) result.rejected = true;
  if (!result.rejected && !map().empty()) {
    build_submap(stamp);
    const bool enough =
        result.edges > config_.min_scan_edges && result.surface > config_.min_scan_surface;
    if (enough && reference_.sufficient(config_.matching)) {
      result.rejected = !register_scan(edges, surface, prior, result);
    }
  }
  if (result.rejected) pose_ = registered_ = before_;
  result.keyframe = !result.rejected && is_keyframe();
  if (result.keyframe) add_keyframe(stamp, std::move(edges), std::move(surface));
  if (!map().empty()) keyframes_.search(stamp, map().last_pose().translation);
  result.degenerate = degenerate_;
  result.T_map_lidar = pose_;
  result.odometry = odometry(stamp, prior);
  return result;
}

}  // namespace aims::lio_sam
