// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/metrics/segments.hpp"
#include "core/error.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Segments that somebody asks for.
struct SegmentList {
  std::vector<Segment> timed;      ///< "a-b=12.5:110.2": seconds of the truth's stamps
  std::vector<std::string> named;  ///< "a-d": between reference points
};

/// Reads a text like "a-b=12.5:110.2,b-a=115:220,a-d". Errors name the entry.
Result<SegmentList> parse_segments(std::string_view text);

/// The asked segments in order of time. Error for one that begins or ends outside the truth's
/// stamps, or whose points are not passed in that order.
Result<std::vector<Segment>> resolve_segments(const SegmentList& list,
                                              std::span<const WaypointTime> waypoint_times,
                                              const Trajectory& truth);

}  // namespace aims
