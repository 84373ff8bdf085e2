// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

#include "core/error.hpp"
#include "recordings/bag/message_sink.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

struct ConversionOutcome {
  bool complete = false;  ///< false when the observer ended it early
  std::uint64_t topics = 0;
  std::uint64_t messages = 0;
};

/// Called now and then with the record time reached; returning false ends the conversion.
using ConversionObserver = std::function<bool(Time record_time)>;

/// Writes every message of `source` to `sink`, which it closes; record times, their order and every
/// value stay. Messages of ROS 1 become those of ROS 2 where the sink takes these. Error, naming
/// the topic, for messages that the sink cannot hold.
Result<ConversionOutcome> convert_messages(MessageSource& source, MessageSink& sink,
                                           const ConversionObserver& observer);

}  // namespace aims
