// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// Norm of the angular velocity, independent of the mounting.
struct TurnRate {
  Time stamp = 0;
  double rate = 0.0;  ///< norm of the angular velocity [rad/s]
};

/// Offset of one sensor's clock to another's.
struct ClockOffset {
  double seconds = 0.0;  ///< stamp of the sensor minus stamp of the reference, for the same motion
  double correlation = 0.0;  ///< of the two rates at that offset, at most 1
};

/// The time offset between two sensors on one body: the peak of the correlation of their angular
/// rates within half a second. `rates` and `reference` are in order of time. Nothing when they
/// overlap by less than 10 s, hardly rotate, or correlate by less than 0.6. A rate averaged over an
/// interval and stamped at its end appears delayed by half the interval.
std::optional<ClockOffset> clock_offset(const std::vector<TurnRate>& rates,
                                        const std::vector<TurnRate>& reference);

}  // namespace aims
