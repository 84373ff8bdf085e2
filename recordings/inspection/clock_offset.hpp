// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// How fast something turns, whichever way it is mounted.
struct TurnRate {
  Time stamp = 0;
  double rate = 0.0;  ///< norm of the angular velocity [rad/s]
};

/// How one sensor's clock stands to another's.
struct ClockOffset {
  double seconds = 0.0;      ///< stamps of the sensor minus stamps of the reference, for one motion
  double correlation = 0.0;  ///< of the two rates at that offset, at most 1
};

/// The offset at which two sensors on one body felt the same turns: the peak of the correlation of
/// their rates within half a second. `rates` and `reference` are in order of time. Nothing when
/// they overlap by less than 10 s, hardly turn, or do not agree. A rate averaged over an interval
/// and stamped at its end counts as half the interval late.
std::optional<ClockOffset> clock_offset(const std::vector<TurnRate>& rates,
                                        const std::vector<TurnRate>& reference);

}  // namespace aims
