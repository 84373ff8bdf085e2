// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// How samples that are recorded in batches were taken: at a steady rate.
struct BatchRate {
  Duration within = 0;   ///< at most, between record times of one batch
  double period = 0.0;   ///< of the samples [ns]
  double samples = 0.0;  ///< of a batch, in the mean
};

/// By the record times of the first samples, in order. Nothing where they come one by one, or the
/// batches are not of a steady rate.
std::optional<BatchRate> batch_rate(const std::vector<Time>& record_times);

/// Times of the samples of one batch after another: spread evenly from the batch before to its
/// record time. Jitter of the record times is smoothed; no sample is later than its record time.
class BatchClock {
 public:
  explicit BatchClock(const BatchRate& rate) : rate_(rate) {}

  std::vector<Time> add(Time record_time, std::size_t samples);

 private:
  BatchRate rate_;
  std::optional<Time> end_;  ///< of the batch before
};

/// Where IMU or legs have no stamps (none, zero, or of a clock that stands) and record times that
/// come in batches of a steady rate, replaces `source` by one whose messages say when they were
/// taken (`BagMessage::sampled`). Reads the first messages of such topics; rewinds.
void spread_batches(std::unique_ptr<MessageSource>& source);

}  // namespace aims
