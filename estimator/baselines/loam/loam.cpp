// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/loam/loam.hpp"

#include <array>

#include "estimator/baselines/features/scan_estimator.hpp"

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

namespace {

features::FeatureCloud transformed(features::FeatureCloud cloud, const Pose& pose) {
  for (features::FeaturePoint& point : cloud) {
    point.position = (pose * point.position.cast<double>()).cast<float>();
  }
  return cloud;
}

}  // namespace

ScanToMap::ScanToMap(const ScanToMapConfig& config)
    : config_(config),
      edges_(config.cube_size, config.edge_voxel),
      planes_(config.cube_size, config.plane_voxel) {}

features::SolverResult ScanToMap::update(const Pose& T_odom_lidar,
                                         const features::RingFeatures& scan) {
  const features::FeatureCloud edges =
      features::voxel_centroids(scan.less_sharp, config_.edge_voxel);
  const features::FeatureCloud planes =
      features::voxel_centroids(scan.less_flat, config_.plane_voxel);
  features::SolverResult result;
  result.pose = to_map(T_odom_lidar);
  reference_.build(edges_.around(result.pose.translation), planes_.around(result.pose.translation));
  if (reference_.sufficient(config_.matching)) {
    const auto associate = [&](const Pose& T_map_lidar) {
      return reference_.match(edges, planes, T_map_lidar, config_.matching);
    };
    result = features::solve_pose(result.pose, associate, config_.solver);
    T_map_odom_ = result.pose * T_odom_lidar.inverse();
    T_map_odom_.rotation.normalize();
  }
  edges_.insert(transformed(edges, result.pose));
  planes_.insert(transformed(planes, result.pose));
  return result;
}

std::vector<Eigen::Vector3f> ScanToMap::points() const {
  std::vector<Eigen::Vector3f> points = edges_.points();
  const std::vector<Eigen::Vector3f> planes = planes_.points();
  points.insert(points.end(), planes.begin(), planes.end());
  return points;
}

namespace {

/// What LOAM reports of a scan.
struct ScanReport {
  int points_in = 0;                              ///< finite returns in range
  int edges = 0;                                  ///< sharp features
  int planes = 0;                                 ///< flat features
  features::SolverResult odometry;                ///< scan to scan
  std::optional<features::SolverResult> mapping;  ///< none: the scan was not registered to the map
};

using Series = ReportedSeries<ScanReport>;

constexpr std::array kOwnSeries = {
    Series{"points_in", "-", "finite points in range",
           [](const ScanReport& s) { return double(s.points_in); }},
    Series{"edges", "-", "sharp features", [](const ScanReport& s) { return double(s.edges); }},
    Series{"planes", "-", "flat features", [](const ScanReport& s) { return double(s.planes); }},
    Series{"iterations", "-", "of odometry and mapping; 0: no update",
           [](const ScanReport& s) {
             return double(s.odometry.iterations + (s.mapping ? s.mapping->iterations : 0));
           }},
    Series{"odometry_matches", "-", "lines and planes of the last scan",
           [](const ScanReport& s) { return double(s.odometry.lines + s.odometry.planes); }},
    Series{"odometry_smallest_eigenvalue", "-",
           "smallest eigenvalue of A^T A in the first iteration, scan to scan",
           [](const ScanReport& s) { return smallest_eigenvalue(s.odometry); }},
    Series{"odometry_removed_directions", "-", "degenerate directions that do not move",
           [](const ScanReport& s) { return double(s.odometry.directions.removed); }},
};

constexpr std::array kSeries = joined(kOwnSeries, features::mapping_series<ScanReport>());

}  // namespace

Loam::Loam(const Config& config, const SensorRig& rig)
    : ScanEstimator(config.queue, rig, series_of(kSeries)),
      config_(config),
      odometry_(config.odometry),
      mapping_(config.mapping) {}

void Loam::process(const LidarScan& scan) {
  features::RingFeatures features = features::ring_features(scan, config_.features);
  ScanReport diagnostics;
  diagnostics.points_in = features.points;
  diagnostics.edges = static_cast<int>(features.sharp.size());
  diagnostics.planes = static_cast<int>(features.flat.size());
  diagnostics.odometry = odometry_.update(features);
  if (scans_++ % config_.mapping.interval == 0) {
    diagnostics.mapping = mapping_.update(odometry_.pose(), features);
  }
  report(mapping_.to_map(odometry_.pose()), scan.end, values_of(kSeries, diagnostics));
}

}  // namespace aims::loam
