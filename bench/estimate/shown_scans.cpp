// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/shown_scans.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aims {
namespace {

constexpr double kGoldenFraction = 0.6180339887498949;  ///< its multiples spread evenly modulo 1

/// Millimetres and hundredths are enough to look at.
double rounded(float value, double step) {
  return std::round(static_cast<double>(value) / step) * step;
}

}  // namespace

std::vector<std::size_t> spread_indices(std::size_t count, std::size_t most) {
  const std::size_t kept = std::min(count, most);
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < kept; ++i) {
    const double place =
        kept == count ? 0.0 : std::fmod(static_cast<double>(i) * kGoldenFraction, 1.0);
    const double part = static_cast<double>(count) / static_cast<double>(kept);
    indices.push_back(static_cast<std::size_t>((static_cast<double>(i) + place) * part));
  }
  return indices;
}

ShownScan shown_scan(const LidarScan& scan, const Trajectory& poses, const Pose& T_body_lidar) {
  ShownScan shown{scan.end, scan.points.size(), {}};
  const auto T_world_end = pose_at(poses, scan.end);
  if (!T_world_end) return shown;
  const Pose T_end_world = T_world_end->inverse();
  for (const std::size_t i : spread_indices(scan.points.size(), kMostShownReturns)) {
    const LidarPoint& point = scan.points[i];
    const auto T_world_body = pose_at(poses, scan.stamp + point.time_offset_ns);
    if (!T_world_body) continue;
    const Eigen::Vector3d p =
        T_end_world * (*T_world_body * (T_body_lidar * point.position.cast<double>()));
    shown.shown.push_back({p.cast<float>(), point.intensity});
  }
  return shown;
}

ScanKeeper::ScanKeeper(Duration length)
    : spacing_(std::max(kShownScanSpacing, length / static_cast<Duration>(kMostShownScans))) {}

bool ScanKeeper::wants(const LidarScan& scan) const {
  return kept_.size() < kMostShownScans && (!next_ || scan.end >= *next_);
}

void ScanKeeper::add(const LidarScan& scan) {
  if (!wants(scan)) return;
  Kept kept{{}, scan.points.size()};
  kept.scan.stamp = scan.stamp;
  kept.scan.end = scan.end;
  for (const std::size_t i : spread_indices(scan.points.size(), kMostShownReturns)) {
    kept.scan.points.push_back(scan.points[i]);
  }
  kept_.push_back(std::move(kept));
  next_ = scan.end + spacing_;
}

std::vector<ShownScan> ScanKeeper::shown(const Trajectory& poses, const Pose& T_body_lidar) const {
  std::vector<ShownScan> scans;
  for (const Kept& each : kept_) {
    ShownScan scan = shown_scan(each.scan, poses, T_body_lidar);
    scan.returns = each.returns;
    if (!scan.shown.empty()) scans.push_back(std::move(scan));
  }
  return scans;
}

CsvTable shown_scans_table(std::span<const ShownScan> scans) {
  CsvTable table({"stamp_s", "returns", "x", "y", "z", "intensity"});
  for (const ShownScan& scan : scans) {
    for (const ShownReturn& each : scan.shown) {
      table.add(to_seconds(scan.stamp)).add(scan.returns);
      for (int axis = 0; axis < 3; ++axis) table.add(rounded(each.p_body[axis], 1e-3));
      table.add(rounded(each.intensity, 1e-2)).end_row();
    }
  }
  return table;
}

}  // namespace aims
