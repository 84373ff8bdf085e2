// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/loam/scan_to_scan.hpp"

#include <utility>

namespace aims::loam {
namespace {

/// Longer motions between two scans are no solutions [m].
constexpr double kMaxMotion = 100.0;

bool plausible(const Pose& motion) {
  return motion.rotation.coeffs().allFinite() && motion.translation.norm() < kMaxMotion;
}

}  // namespace

void move_to_scan_end(features::FeatureCloud& cloud, const Pose& motion) {
  const Pose T_end_start = motion.inverse();
  for (features::FeaturePoint& point : cloud) {
    const Eigen::Vector3d at_start =
        features::part_of(motion, point.fraction) * point.position.cast<double>();
    point.position = (T_end_start * at_start).cast<float>();
    point.fraction = 1.0F;
  }
}

features::SolverResult ScanToScan::update(features::RingFeatures& scan) {
  features::SolverResult result;
  if (started_) {
    result.pose = motion_;
    if (static_cast<int>(edges_.size()) > config_.min_edges &&
        static_cast<int>(planes_.size()) > config_.min_planes) {
      const auto associate = [&](const Pose& motion) { return match(scan, motion); };
      result = features::solve_pose(motion_, associate, config_.solver);
    }
    motion_ = plausible(result.pose) ? result.pose : Pose();
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

features::FeatureMatches ScanToScan::match(const features::RingFeatures& scan,
                                           const Pose& motion) const {
  features::FeatureMatches matches;
  const auto fraction_of = [&](const features::FeaturePoint& point) {
    return config_.deskew ? static_cast<double>(point.fraction) : 1.0;
  };
  const auto at_start = [&](const features::FeaturePoint& point) -> Eigen::Vector3f {
    return (features::part_of(motion, fraction_of(point)) * point.position.cast<double>())
        .cast<float>();
  };
  for (const features::FeaturePoint& sharp : scan.sharp) {
    auto line = edges_.line_near(at_start(sharp), config_.matching);
    if (!line) continue;
    line->point = sharp.position.cast<double>();
    line->fraction = fraction_of(sharp);
    matches.lines.push_back(*line);
  }
  for (const features::FeaturePoint& flat : scan.flat) {
    auto plane = planes_.plane_near(at_start(flat), config_.matching);
    if (!plane) continue;
    plane->point = flat.position.cast<double>();
    plane->fraction = fraction_of(flat);
    matches.planes.push_back(*plane);
  }
  return matches;
}

}  // namespace aims::loam
