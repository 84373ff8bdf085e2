// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/drift.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kShortestDirection = 0.1;  ///< [m]; a shorter segment has no direction

/// Horizontal unit vector from the segment's begin to its end, by the truth.
std::optional<Eigen::Vector3d> direction_of(const Trajectory& truth, const Segment& segment) {
  const auto begin = pose_at(truth, segment.begin);
  const auto end = pose_at(truth, segment.end);
  if (!begin || !end) return std::nullopt;
  Eigen::Vector3d along = end->translation - begin->translation;
  along.z() = 0.0;
  if (along.norm() < kShortestDirection) return std::nullopt;
  return along.normalized();
}

AxisError split(const PosePair& pair, const Eigen::Vector3d& along) {
  const Eigen::Vector3d error = pair.estimate.translation - pair.truth.translation;
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(along);
  return {along.dot(error), left.dot(error), error.z(),
          wrap_angle(yaw_of(pair.estimate.rotation) - yaw_of(pair.truth.rotation))};
}

void add_square(AxisError& sum, const AxisError& e) {
  sum.along_m += e.along_m * e.along_m;
  sum.lateral_m += e.lateral_m * e.lateral_m;
  sum.vertical_m += e.vertical_m * e.vertical_m;
  sum.heading_rad += e.heading_rad * e.heading_rad;
}

void raise(AxisError& largest, const AxisError& e) {
  largest.along_m = std::max(largest.along_m, std::abs(e.along_m));
  largest.lateral_m = std::max(largest.lateral_m, std::abs(e.lateral_m));
  largest.vertical_m = std::max(largest.vertical_m, std::abs(e.vertical_m));
  largest.heading_rad = std::max(largest.heading_rad, std::abs(e.heading_rad));
}

AxisError root_of_mean(const AxisError& sum, double count) {
  return {std::sqrt(sum.along_m / count), std::sqrt(sum.lateral_m / count),
          std::sqrt(sum.vertical_m / count), std::sqrt(sum.heading_rad / count)};
}

/// The pair at `stamp`, or none outside either trajectory.
std::optional<PosePair> pair_at(const Trajectory& estimate, const Trajectory& truth, Time stamp) {
  const auto estimated = pose_at(estimate, stamp);
  const auto true_pose = pose_at(truth, stamp);
  if (!estimated || !true_pose) return std::nullopt;
  return PosePair{stamp, *estimated, *true_pose};
}

}  // namespace

std::vector<SegmentDrift> segment_drifts(const Trajectory& estimate, const Trajectory& truth,
                                         std::span<const Segment> segments, Duration edge) {
  std::vector<SegmentDrift> drifts;
  for (const Segment& segment : segments) {
    const auto along = direction_of(truth, segment);
    if (!along) continue;
    SegmentDrift drift{segment, std::nullopt};
    const auto begin = within_span(estimate, segment.begin, edge);
    const auto end = within_span(estimate, segment.end, edge);
    const auto first = begin ? pair_at(estimate, truth, *begin) : std::nullopt;
    auto last = end ? pair_at(estimate, truth, *end) : std::nullopt;
    if (first && last && first->stamp < last->stamp) {
      last->estimate = first->truth * (first->estimate.inverse() * last->estimate);
      drift.at_end = split(*last, *along);
    }
    drifts.push_back(std::move(drift));
  }
  return drifts;
}

std::optional<DriftSummary> drift_summary(std::span<const PosePair> pairs, const Trajectory& truth,
                                          std::span<const Segment> segments) {
  std::vector<std::pair<Time, Eigen::Vector3d>> ways;  // end of the segment, its direction
  for (const Segment& segment : segments) {
    if (const auto along = direction_of(truth, segment)) ways.emplace_back(segment.end, *along);
  }
  if (pairs.empty() || ways.empty()) return std::nullopt;
  DriftSummary summary;
  std::size_t way = 0;
  for (const PosePair& pair : pairs) {
    while (way + 1 < ways.size() && pair.stamp > ways[way].first) ++way;
    summary.end = split(pair, ways[way].second);
    add_square(summary.rmse, summary.end);
    raise(summary.max, summary.end);
  }
  summary.rmse = root_of_mean(summary.rmse, static_cast<double>(pairs.size()));
  return summary;
}

}  // namespace aims
