// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/lie.hpp"
#include "core/measurements.hpp"
#include "estimator/lidar/deskew.hpp"
#include "estimator/lidar/dynamic_points.hpp"
#include "estimator/lidar/four_points.hpp"
#include "estimator/lidar/lidar_config.hpp"
#include "estimator/lidar/scan_selection.hpp"

namespace aims {

/// Whether more than half of the returns of a scan are left out by their ranges.
enum class LeftOutByRange { kFew, kTooNear, kTooFar };

/// From the returns of a raw scan to the points that are matched and those that are mapped: left
/// out are mixed returns and those on things that move; the rest is thinned and deskewed.
class ScanPoints {
 public:
  /// `lever`: the LiDAR in body axes [m].
  ScanPoints(const LidarUpdateConfig& lidar, const MapConfig& map, const Eigen::Vector3d& lever);

  /// Replaces the points by those of `scan`. `T_odom_body`: the predicted pose at its end.
  void prepare(const LidarScan& scan, const ScanMotion& motion, const Pose& T_odom_body);

  /// Points to be matched, in body axes at the scan's end [m].
  const std::vector<Eigen::Vector3f>& to_match() const { return to_match_; }

  /// Points to be mapped, likewise.
  const std::vector<Eigen::Vector3f>& to_map() const { return to_map_; }

  /// Returns of the scan that are finite and in range.
  int in_range() const { return in_range_; }

  /// Of the scan, which is that of `prepare`: which limit leaves out most of its returns.
  LeftOutByRange left_out(const LidarScan& scan) const;

  /// Points to be mapped that were left out since they may move.
  int moving() const { return moving_count_; }

  /// Keeps the scan, at its corrected pose, to find what moves in later ones.
  void keep(const Pose& T_odom_body) { moving_.keep(T_odom_body); }

  /// Forgets the scans that were kept.
  void forget() { moving_.forget(); }

 private:
  void find_moving(const LidarScan& scan, const ScanMotion& motion, const Pose& T_odom_body);

  LidarUpdateConfig lidar_;
  MapConfig map_;
  ScanSelection selection_;
  DynamicPoints moving_;
  int in_range_ = 0;
  int moving_count_ = 0;
  std::vector<int> indices_;  ///< of the returns selected last
  PointBlocks image_;         ///< points by which scans are compared
  std::vector<Eigen::Vector3f> to_match_;
  std::vector<Eigen::Vector3f> to_map_;
};

}  // namespace aims
