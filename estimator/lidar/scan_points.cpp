// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_points.hpp"

#include <algorithm>

namespace aims {
namespace {

/// Returns that a scan is compared with earlier ones by, at most: two per pixel of a RangeImage.
constexpr int kMaxImagePoints = 10000;

/// Returns of one scan that are mapped, at most: a bound on time.
constexpr int kMaxInsertions = 12000;

}  // namespace

ScanPoints::ScanPoints(const LidarUpdateConfig& lidar, const MapConfig& map,
                       const Eigen::Vector3d& lever)
    : lidar_(lidar), map_(map), selection_(lidar), moving_(lever) {}

void ScanPoints::prepare(const LidarScan& scan, const ScanMotion& motion, const Pose& T_odom_body) {
  in_range_ = selection_.begin(scan);
  find_moving(scan, motion, T_odom_body);
  const auto select = [&](double voxel, int limit, std::vector<Eigen::Vector3f>& points) {
    selection_.select(voxel, limit, indices_);
    deskew(scan, indices_, motion, points);
  };
  // Each selection chooses among the returns that the one before left: the finer one is first.
  const bool map_is_finer = map_.insertion_voxel <= lidar_.selection_voxel;
  if (map_is_finer) select(map_.insertion_voxel, kMaxInsertions, to_map_);
  select(lidar_.selection_voxel, lidar_.max_points, to_match_);
  if (!map_is_finer) select(map_.insertion_voxel, kMaxInsertions, to_map_);
  moving_.remove_from(to_match_);
  moving_count_ = moving_.remove_from(to_map_);
}

LeftOutByRange ScanPoints::left_out(const LidarScan& scan) const {
  if (2 * static_cast<std::size_t>(in_range_) >= scan.points.size()) return LeftOutByRange::kFew;
  const auto near = std::ranges::count_if(scan.points, [this](const LidarPoint& point) {
    return point.position.norm() < static_cast<float>(lidar_.min_range);
  });
  const auto far = std::ssize(scan.points) - in_range_ - near;
  return near > far ? LeftOutByRange::kTooNear : LeftOutByRange::kTooFar;
}

/// Compares the scan with earlier ones, before its returns are thinned.
void ScanPoints::find_moving(const LidarScan& scan, const ScanMotion& motion,
                             const Pose& T_odom_body) {
  selection_.thin(kMaxImagePoints, indices_);
  deskew(scan, indices_, motion, image_);
  moving_.compare(image_, scan.end, T_odom_body);
}

}  // namespace aims
