// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/measurements.hpp"

namespace aims {

/// Removes single samples of one sensor whose stamps jump ahead of their neighbours. A stamp jumps
/// when it is further ahead of its arrival than any before it, by more than `kMaxAdvance`. Such a
/// sample waits for the next one: that continues either the jump, then the sensor's clock was set,
/// or the stamps before it, then the sample is dropped.
class StampJumps {
 public:
  /// What the delay of a link may shrink by from one sample to the next.
  static constexpr double kMaxAdvance = 0.2;  ///< [s]

  /// `hold_first`: the first sample waits for the second, since nothing vouches for it.
  explicit StampJumps(bool hold_first) : hold_first_(hold_first) {}

  /// Appends the deliveries that are now known to be good, in order of arrival.
  void take(const Delivery& delivery, std::vector<Delivery>& good);

  int dropped() const { return dropped_; }          ///< samples so far
  int clock_jumps() const { return clock_jumps_; }  ///< of the sensor's clock so far

 private:
  bool jumps(const Delivery& delivery) const;
  bool continues_held(const Delivery& delivery) const;
  void accept(const Delivery& delivery, std::vector<Delivery>& good);

  bool hold_first_;
  std::optional<double> largest_advance_;  ///< of a stamp over its arrival [s]; negative: a delay
  std::optional<Delivery> held_;
  int dropped_ = 0;
  int clock_jumps_ = 0;
};

}  // namespace aims
