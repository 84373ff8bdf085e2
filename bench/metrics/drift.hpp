// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/metrics/association.hpp"
#include "bench/metrics/segments.hpp"

namespace aims {

/// An error split by the way being walked: along = horizontal direction of the true segment,
/// lateral = to its left, vertical = up. Signed unless it summarizes many.
struct AxisError {
  double along_m = 0.0;
  double lateral_m = 0.0;
  double vertical_m = 0.0;
  double heading_rad = 0.0;  ///< estimated minus true, wrapped
};

/// Drift gathered over one segment, with the estimate laid onto the truth at the segment's begin.
struct SegmentDrift {
  Segment segment;
  std::optional<AxisError> at_end;  ///< none: no estimate at the segment's ends
};

/// Errors of the start-anchored estimate over the whole run, each pair split along the segment
/// being walked then (before the first and after the last: that one).
struct DriftSummary {
  AxisError rmse;
  AxisError max;  ///< largest absolute values
  AxisError end;  ///< signed, of the last pair
};

/// Drift over each segment; `edge` as for `segment_distances`.
std::vector<SegmentDrift> segment_drifts(const Trajectory& estimate, const Trajectory& truth,
                                         std::span<const Segment> segments, Duration edge);

/// Split errors of aligned pairs; none without pairs or without a segment that has a direction.
std::optional<DriftSummary> drift_summary(std::span<const PosePair> pairs, const Trajectory& truth,
                                          std::span<const Segment> segments);

}  // namespace aims
