// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/topics/recording_channels.hpp"

namespace aims {

/// The numbers that tell a new sample from one that was sent again: those of an IMU; IMU, joints,
/// feet and loads of a robot's state. Empty for other messages.
std::vector<double> sample_numbers(const MessageView& message, const Channel& channel);

/// Finds out whether a driver sends each sample several times under new stamps, as Unitree's
/// HighState of 500 Hz, which is new each 20 ms.
class RepeatFinder {
 public:
  /// Returns whether the sample is another one than that before.
  bool add(Time stamp, std::vector<double> numbers);

  /// The time from sample to sample, if most are sent twice or more. A sensor at rest without noise
  /// repeats one sample for long, but not most of them.
  std::optional<Duration> period() const;
  std::size_t messages() const { return messages_; }
  std::size_t samples() const { return stamps_.size(); }

 private:
  std::vector<double> last_;
  std::vector<Time> stamps_;             ///< of new samples
  std::vector<std::size_t> runs_ = {0};  ///< messages of each sample
  std::size_t messages_ = 0;
};

/// Recognizes the repetitions.
class RepeatFilter {
 public:
  explicit RepeatFilter(Duration period) : period_(period) {}

  /// Whether the last new sample is sent again. After 1.5 periods it counts as new.
  bool repeats(Time stamp, std::vector<double> numbers);

 private:
  Duration period_;
  std::optional<Time> new_since_;
  std::vector<double> last_;
};

}  // namespace aims
