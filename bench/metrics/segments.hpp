// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/trajectory.hpp"

namespace aims {

/// The part of a route between two waypoints.
struct Segment {
  std::string name;  ///< "a-b"; the second of the same name is "a-b#2"
  Time begin = 0;    ///< true time at the first waypoint
  Time end = 0;      ///< true time at the second waypoint
};

/// The segments between consecutive waypoint times in order of time.
std::vector<Segment> segments_of(std::span<const WaypointTime> waypoint_times);

/// The segments of the given names ("a-d"), in order of time: from a waypoint time of the first
/// point to the next waypoint time of the second, other points in between or not, but neither of
/// the two.
std::vector<Segment> segments_named(std::span<const WaypointTime> waypoint_times,
                                    std::span<const std::string> names);

/// The segments of those names, or between consecutive waypoint times when there are no names.
std::vector<Segment> segments_wanted(std::span<const WaypointTime> waypoint_times,
                                     std::span<const std::string> names);

/// M_list of one segment. Distances are straight lines between the two ends, d_i of the truth and
/// d_hat_i of the estimate at the same times.
struct SegmentDistance {
  Segment segment;
  double true_distance_m = 0.0;                ///< d_i
  std::optional<double> estimated_distance_m;  ///< d_hat_i; none without an estimate at the ends
  std::optional<double> percent;               ///< 100 |d_hat_i - d_i| / d_i
  std::optional<double> signed_percent;        ///< 100 (d_hat_i - d_i) / d_i; < 0: shortened
};

/// Where the estimate has poses.
struct PoseCoverage {
  Duration edge = 0;  ///< an end of a segment this near to a pose moves to it
  Duration gap = 0;   ///< between poses further apart there is no estimate
};

/// Distances of every segment at least `min_length` [m] long. A segment's end up to `edge` outside
/// the estimate's span, or in a gap of the estimate, moves to the pose there for the truth and the
/// estimate alike; further from any pose the segment has no estimate.
std::vector<SegmentDistance> segment_distances(const Trajectory& estimate, const Trajectory& truth,
                                               std::span<const Segment> segments, double min_length,
                                               const PoseCoverage& coverage);

/// M_list over all segments in percent: 100 sum |d_hat_i - d_i| / sum d_i (unnumbered equation of
/// the paper's section III.A); none when there is no segment or one lacks its estimate.
std::optional<double> m_list_percent(std::span<const SegmentDistance> distances);

/// `stamp`, or the nearer end of the trajectory's span when that is at most `edge` away.
std::optional<Time> within_span(const Trajectory& trajectory, Time stamp, Duration edge);

/// The same, and within a gap the nearer pose when that is at most `edge` away.
std::optional<Time> covered(const Trajectory& trajectory, Time stamp, const PoseCoverage& coverage);

}  // namespace aims
