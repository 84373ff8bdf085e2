// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/two_step_odometry.hpp"

namespace aims::lego_loam {
namespace {

// Coordinates of the pose that each step moves; z is up.
features::PoseCoordinates roll_pitch_height() { return {0, 1, 5}; }
features::PoseCoordinates heading_and_plane() { return {2, 3, 4}; }

}  // namespace

OdometryResult TwoStepOdometry::solve(const features::RingFeatures& scan) const {
  OdometryResult result;
  result.ground.pose = motion_;
  result.edges.pose = motion_;
  if (static_cast<int>(edges_.size()) < config_.min_edges ||
      static_cast<int>(planes_.size()) < config_.min_planes) {
    return result;
  }
  const auto planes = [&](const Pose& motion) -> features::FeatureMatches {
    return {{}, plane_matches(scan.flat, motion, true, planes_, config_.matching)};
  };
  const auto lines = [&](const Pose& motion) -> features::FeatureMatches {
    return {line_matches(scan.sharp, motion, true, edges_, config_.matching), {}};
  };
  result.ground = features::solve_pose(motion_, planes, config_.solver, roll_pitch_height());
  result.edges =
      features::solve_pose(result.ground.pose, lines, config_.solver, heading_and_plane());
  return result;
}

OdometryResult TwoStepOdometry::update(features::RingFeatures& scan) {
  OdometryResult result;
  if (started_) {
    result = solve(scan);
    motion_ = features::plausible_motion(result.edges.pose) ? result.edges.pose : Pose();
    T_odom_lidar_ = T_odom_lidar_ * motion_;
    T_odom_lidar_.rotation.normalize();
  }
  move_to_scan_end(scan.less_sharp, motion_);
  move_to_scan_end(scan.less_flat, motion_);
  edges_.set(scan.less_sharp);
  planes_.set(scan.less_flat);
  started_ = true;
  return result;
}

}  // namespace aims::lego_loam
