// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "recordings/event_counts.hpp"
#include "recordings/stream/latency_changes.hpp"
#include "recordings/stream/recording_plan.hpp"
#include "recordings/stream/stamp_leaps.hpp"

namespace aims {

/// What stamps against record times tell over a whole recording: clocks that leap, or that run at
/// different rates.
class StampWatch {
 public:
  /// `latency`: record time minus stamp.
  void add(Role role, Time recorded, Duration latency) {
    trends_[static_cast<std::size_t>(role)].add(recorded, latency);
  }

  /// By how much the stamp of a message is wrong, where it leapt and those of the IMU did not;
  /// `late`: how long after its stamp and the usual latency it was recorded.
  std::optional<Duration> leap_of(Role role, Time stamp, Duration late, Time recorded);

  /// Adds to the warnings of `plan` and to `counts`.
  void finish(RecordingPlan& plan, EventCounts& counts) const;

 private:
  void warn_of_leaps(RecordingPlan& plan, EventCounts& counts) const;
  void warn_of_imu_leap(RecordingPlan& plan, EventCounts& counts) const;
  void warn_of_rates(RecordingPlan& plan) const;

  std::array<LatencyTrend, kRoleCount> trends_;
  SteadyTopic steady_imu_;
  std::array<StampLeaps, kRoleCount> leaps_;
};

}  // namespace aims
