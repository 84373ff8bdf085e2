// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/drift.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kMinLength = 0.1;  ///< of a segment with a direction [m]

/// Horizontal unit vector from the segment's begin to its end, by the truth.
std::optional<Eigen::Vector3d> direction_of(const Trajectory& truth, const Segment& segment) {
  const auto begin = pose_at(truth, segment.begin);
  const auto end = pose_at(truth, segment.end);
  if (!begin || !end) return std::nullopt;
  Eigen::Vector3d along = end->translation - begin->translation;
  along.z() = 0.0;
  if (along.norm() < kMinLength) return std::nullopt;
  return along.normalized();
}

/// Angle between the directions in which both attitudes see the vertical; roll and pitch at once.
double tilt_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Vector3d up_a = a.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_b = b.conjugate() * Eigen::Vector3d::UnitZ();
  return std::atan2(up_a.cross(up_b).norm(), up_a.dot(up_b));
}

AxisError split(const PosePair& pair, const Eigen::Vector3d& along) {
  const Eigen::Vector3d error = pair.estimate.translation - pair.truth.translation;
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(along);
  return {along.dot(error), left.dot(error), error.z(),
          wrap_angle(yaw_of(pair.estimate.rotation) - yaw_of(pair.truth.rotation)),
          tilt_between(pair.estimate.rotation, pair.truth.rotation)};
}

void add_square(AxisError& sum, const AxisError& e) {
  sum.longitudinal_m += e.longitudinal_m * e.longitudinal_m;
  sum.lateral_m += e.lateral_m * e.lateral_m;
  sum.vertical_m += e.vertical_m * e.vertical_m;
  sum.heading_rad += e.heading_rad * e.heading_rad;
  sum.tilt_rad += e.tilt_rad * e.tilt_rad;
}

void raise(AxisError& largest, const AxisError& e) {
  largest.longitudinal_m = std::max(largest.longitudinal_m, std::abs(e.longitudinal_m));
  largest.lateral_m = std::max(largest.lateral_m, std::abs(e.lateral_m));
  largest.vertical_m = std::max(largest.vertical_m, std::abs(e.vertical_m));
  largest.heading_rad = std::max(largest.heading_rad, std::abs(e.heading_rad));
  largest.tilt_rad = std::max(largest.tilt_rad, e.tilt_rad);
}

AxisError root_of_mean(const AxisError& sum, double count) {
  return {std::sqrt(sum.longitudinal_m / count), std::sqrt(sum.lateral_m / count),
          std::sqrt(sum.vertical_m / count), std::sqrt(sum.heading_rad / count),
          std::sqrt(sum.tilt_rad / count)};
}

}  // namespace

std::optional<DriftSummary> drift_summary(std::span<const PosePair> pairs, const Trajectory& truth,
                                          std::span<const Segment> segments) {
  std::vector<std::pair<Time, Eigen::Vector3d>> directions;  // with the end of each segment
  for (const Segment& segment : segments) {
    if (const auto along = direction_of(truth, segment))
      directions.emplace_back(segment.end, *along);
  }
  if (pairs.empty() || directions.empty()) return std::nullopt;
  DriftSummary summary;
  std::size_t current = 0;
  for (const PosePair& pair : pairs) {
    while (current + 1 < directions.size() && pair.stamp > directions[current].first) ++current;
    summary.end = split(pair, directions[current].second);
    add_square(summary.rmse, summary.end);
    raise(summary.max, summary.end);
  }
  summary.rmse = root_of_mean(summary.rmse, static_cast<double>(pairs.size()));
  return summary;
}

}  // namespace aims
