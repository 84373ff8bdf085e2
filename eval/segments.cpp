// SPDX-License-Identifier: BSD-3-Clause
#include "eval/segments.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Straight-line distance [m] between the poses at two instants.
std::optional<double> distance_between(const Trajectory& trajectory, Time begin, Time end) {
  const auto first = pose_at(trajectory, begin);
  const auto last = pose_at(trajectory, end);
  if (!first || !last) return std::nullopt;
  return (last->translation - first->translation).norm();
}

}  // namespace

std::vector<Segment> segments_of(std::span<const Passage> passages) {
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < passages.size(); ++i) {
    const std::string name = passages[i - 1].point + "-" + passages[i].point;
    const auto same = [&name](const Segment& each) {
      return each.name == name || each.name.starts_with(name + "#");
    };
    const auto earlier = std::count_if(segments.begin(), segments.end(), same);
    segments.push_back({earlier == 0 ? name : name + "#" + std::to_string(earlier + 1),
                        passages[i - 1].stamp, passages[i].stamp});
  }
  return segments;
}

std::optional<Time> within_span(const Trajectory& trajectory, Time stamp, Duration edge) {
  if (trajectory.empty()) return std::nullopt;
  const Time clamped = std::clamp(stamp, trajectory.front().stamp, trajectory.back().stamp);
  if (std::abs(clamped - stamp) > edge) return std::nullopt;
  return clamped;
}

std::vector<SegmentDistance> segment_distances(const Trajectory& estimate, const Trajectory& truth,
                                               std::span<const Segment> segments, double shortest,
                                               Duration edge) {
  std::vector<SegmentDistance> distances;
  for (const Segment& segment : segments) {
    const auto whole = distance_between(truth, segment.begin, segment.end);
    if (!whole || *whole < shortest) continue;
    SegmentDistance distance{segment, *whole, std::nullopt, std::nullopt, std::nullopt};
    const auto begin = within_span(estimate, segment.begin, edge);
    const auto end = within_span(estimate, segment.end, edge);
    const auto true_distance = begin && end ? distance_between(truth, *begin, *end) : std::nullopt;
    if (true_distance && *true_distance >= shortest) {
      const double estimated = *distance_between(estimate, *begin, *end);
      distance.true_distance_m = *true_distance;
      distance.estimated_distance_m = estimated;
      distance.signed_percent = 100.0 * (estimated - *true_distance) / *true_distance;
      distance.percent = std::abs(*distance.signed_percent);
    }
    distances.push_back(std::move(distance));
  }
  return distances;
}

std::optional<double> m_list_percent(std::span<const SegmentDistance> distances) {
  double error = 0.0;
  double length = 0.0;
  for (const SegmentDistance& each : distances) {
    if (!each.estimated_distance_m) return std::nullopt;
    error += std::abs(*each.estimated_distance_m - each.true_distance_m);
    length += each.true_distance_m;
  }
  if (!(length > 0.0)) return std::nullopt;
  return 100.0 * error / length;
}

}  // namespace aims
