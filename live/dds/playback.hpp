// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"
#include "live/dds/dds_transport.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

struct PlaybackOptions {
  double rate = 1.0;                ///< of the recording's pace
  std::vector<std::string> topics;  ///< empty: all
  bool wait = false;  ///< starts once each topic has a subscriber; else after a second
  std::function<void(const std::string&)> waiting;  ///< told every 5 s for what it waits
};

struct PlaybackOutcome {
  std::uint64_t topics = 0;
  std::uint64_t messages = 0;
  std::uint64_t blocked = 0;         ///< not sent, since subscribers were too slow
  std::uint64_t unsendable = 0;      ///< not sent, since DDS cannot hold their record times
  Time unsendable_time = 0;          ///< the first of these
  std::size_t unanswered = 0;        ///< topics of which a subscriber did not acknowledge the end
  std::vector<std::string> skipped;  ///< topics that ROS 2 cannot hold, with the reason
  bool complete = false;             ///< false when it was interrupted
};

/// Publishes the recording's messages at its pace; those of ROS 1 as ROS 2 has them. The time of
/// sending is the record time. Error, naming the topic, for a broken recording.
Result<PlaybackOutcome> play(MessageSource& recording, DdsTransport& transport,
                             const PlaybackOptions& options);

}  // namespace aims
