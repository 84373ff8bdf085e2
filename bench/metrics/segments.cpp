// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/segments.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace aims {
namespace {

/// Straight-line distance [m] between the poses at two instants.
std::optional<double> distance_between(const Trajectory& trajectory, Time begin, Time end) {
  const auto first = pose_at(trajectory, begin);
  const auto last = pose_at(trajectory, end);
  if (!first || !last) return std::nullopt;
  return (last->translation - first->translation).norm();
}

std::string name_of(const WaypointTime& from, const WaypointTime& to) {
  return from.point + "-" + to.point;
}

/// Adds a segment; one of the same name as an earlier one is numbered.
void add_segment(const WaypointTime& from, const WaypointTime& to, std::vector<Segment>& segments) {
  const std::string name = name_of(from, to);
  const auto same = [&name](const Segment& each) {
    return each.name == name || each.name.starts_with(name + "#");
  };
  const auto earlier = std::count_if(segments.begin(), segments.end(), same);
  segments.push_back(
      {earlier == 0 ? name : name + "#" + std::to_string(earlier + 1), from.stamp, to.stamp});
}

}  // namespace

std::vector<Segment> segments_of(std::span<const WaypointTime> waypoint_times) {
  std::vector<Segment> segments;
  for (std::size_t i = 1; i < waypoint_times.size(); ++i) {
    add_segment(waypoint_times[i - 1], waypoint_times[i], segments);
  }
  return segments;
}

std::vector<Segment> segments_named(std::span<const WaypointTime> waypoint_times,
                                    std::span<const std::string> names) {
  std::vector<Segment> segments;
  for (std::size_t i = 0; i < waypoint_times.size(); ++i) {
    for (std::size_t j = i + 1; j < waypoint_times.size(); ++j) {
      const bool wanted = std::find(names.begin(), names.end(),
                                    name_of(waypoint_times[i], waypoint_times[j])) != names.end();
      const auto between = waypoint_times.subspan(i + 1, j - i - 1);
      const bool direct =
          std::none_of(between.begin(), between.end(), [&](const WaypointTime& each) {
            return each.point == waypoint_times[i].point || each.point == waypoint_times[j].point;
          });
      if (wanted && direct) add_segment(waypoint_times[i], waypoint_times[j], segments);
    }
  }
  return segments;
}

std::vector<Segment> segments_wanted(std::span<const WaypointTime> waypoint_times,
                                     std::span<const std::string> names) {
  return names.empty() ? segments_of(waypoint_times) : segments_named(waypoint_times, names);
}

std::optional<Time> within_span(const Trajectory& trajectory, Time stamp, Duration edge) {
  if (trajectory.empty()) return std::nullopt;
  const Time clamped = std::clamp(stamp, trajectory.front().stamp, trajectory.back().stamp);
  if (std::abs(clamped - stamp) > edge) return std::nullopt;
  return clamped;
}

std::optional<Time> covered(const Trajectory& trajectory, Time stamp,
                            const PoseCoverage& coverage) {
  const std::optional<Time> inside = within_span(trajectory, stamp, coverage.edge);
  if (!inside) return std::nullopt;
  const auto after = std::ranges::lower_bound(trajectory, *inside, {}, &StampedPose::stamp);
  if (after == trajectory.begin() || after->stamp == *inside) return inside;
  const Time before = std::prev(after)->stamp;
  if (after->stamp - before <= coverage.gap) return inside;
  const Time nearer = *inside - before < after->stamp - *inside ? before : after->stamp;
  if (std::abs(nearer - *inside) > coverage.edge) return std::nullopt;
  return nearer;
}

std::vector<SegmentDistance> segment_distances(const Trajectory& estimate, const Trajectory& truth,
                                               std::span<const Segment> segments, double min_length,
                                               const PoseCoverage& coverage) {
  std::vector<SegmentDistance> distances;
  for (const Segment& segment : segments) {
    const auto whole = distance_between(truth, segment.begin, segment.end);
    if (!whole || *whole < min_length) continue;
    SegmentDistance distance{segment, *whole, std::nullopt, std::nullopt, std::nullopt};
    const auto begin = covered(estimate, segment.begin, coverage);
    const auto end = covered(estimate, segment.end, coverage);
    const auto true_distance = begin && end ? distance_between(truth, *begin, *end) : std::nullopt;
    if (true_distance && *true_distance >= min_length) {
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
