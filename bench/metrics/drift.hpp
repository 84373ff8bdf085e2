// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/metrics/association.hpp"
#include "bench/metrics/segments.hpp"

namespace aims {

/// A position error in the axes of the present route segment: longitudinal = horizontal direction
/// of the true segment, lateral = to its left, vertical = up; and that of the attitude. Signed
/// unless it summarizes many.
struct AxisError {
  double longitudinal_m = 0.0;
  double lateral_m = 0.0;
  double vertical_m = 0.0;
  double heading_rad = 0.0;  ///< estimated minus true, wrapped
  double tilt_rad = 0.0;     ///< angle between estimated and true vertical in body axes, unsigned
};

/// Errors of the estimate aligned at the start, each in the axes of the segment of that time
/// (before the first segment: the first; after the last: the last).
struct DriftSummary {
  AxisError rmse;
  AxisError max;  ///< largest absolute values
  AxisError end;  ///< signed, of the last pair
  bool has_attitude = true;  ///< false: the truth has none; heading and tilt are no errors then
};

/// Errors of aligned pairs; none without pairs or without a segment that has a direction.
std::optional<DriftSummary> drift_summary(std::span<const PosePair> pairs, const Trajectory& truth,
                                          std::span<const Segment> segments);

}  // namespace aims
