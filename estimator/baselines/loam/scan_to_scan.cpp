// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/loam/scan_to_scan.hpp"

namespace aims::loam {

features::SolverResult ScanToScan::update(features::RingFeatures& scan) {
  features::SolverResult result;
  if (started_) {
    result.pose = motion_;
    if (static_cast<int>(edges_.size()) > config_.min_edges &&
        static_cast<int>(planes_.size()) > config_.min_planes) {
      const auto associate = [&](const Pose& motion) -> features::FeatureMatches {
        return {line_matches(scan.sharp, motion, config_.deskew, edges_, config_.matching),
                plane_matches(scan.flat, motion, config_.deskew, planes_, config_.matching)};
      };
      result = features::solve_pose(motion_, associate, config_.solver);
    }
    motion_ = features::plausible_motion(result.pose) ? result.pose : Pose();
    T_odom_lidar_ = T_odom_lidar_ * motion_;
    T_odom_lidar_.rotation.normalize();
  }
  if (config_.deskew) {
    move_to_scan_end(scan.less_sharp, motion_);
    move_to_scan_end(scan.less_flat, motion_);
  }
  edges_.set(scan.less_sharp);
  planes_.set(scan.less_flat);
  started_ = true;
  return result;
}

}  // namespace aims::loam
