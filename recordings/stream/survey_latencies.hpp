// SPDX-License-Identifier: BSD-3-Clause
// What the files of the survey that judge clocks share.
#pragma once

#include <algorithm>
#include <vector>

#include "core/time.hpp"
#include "recordings/clouds/stamp_steps.hpp"

namespace aims {

/// Between the latencies of sensors on one clock.
inline constexpr Duration kMaxLatencyDifference = kSecond / 4;
/// A step back of stamps that is no exchange of neighbours.
inline constexpr Duration kMaxDisorder = kSecond / 5;

/// Whether stamps are none to read.
inline bool stamps_stand(const std::vector<Time>& stamps) {
  std::size_t steps = 0;
  for (std::size_t i = 1; i < stamps.size(); ++i) steps += stamps[i] != stamps[i - 1] ? 1 : 0;
  return hardly_advance(steps, stamps.size());
}

/// The latency that a tenth of the messages do not reach: others were delayed.
inline Duration early_latency(std::vector<Duration> latencies) {
  const auto at = latencies.begin() + static_cast<std::ptrdiff_t>(latencies.size() / 10);
  std::ranges::nth_element(latencies, at);
  return *at;
}

}  // namespace aims
