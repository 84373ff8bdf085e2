// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "recordings/bag/message_sink.hpp"
#include "recordings/bag/message_source.hpp"
#include "recordings/messages/cdr_transcoder.hpp"

namespace aims {

/// Writes messages of a source to a sink, which must outlive it; adds their topics to the sink.
/// Messages of ROS 1 become those of ROS 2 where the sink takes these.
class MessageConverter {
 public:
  /// `source`: its name, for errors.
  MessageConverter(std::string source, MessageSink& sink);

  /// Error, naming the topic, for a message that the sink cannot hold.
  Result<void> write(const BagMessage& message);

  std::uint64_t topics() const { return routes_.size(); }

 private:
  /// A topic of the source on its way into the sink.
  struct Route {
    std::uint32_t id = 0;  ///< in the sink
    std::optional<CdrTranscoder> transcoder;
  };
  tl::unexpected<Error> refuse(const BagConnection& connection, const Error& error) const;
  Result<Route> route_of(const BagConnection& connection);

  std::string source_;
  MessageSink& sink_;
  std::map<std::uint32_t, Route> routes_;  ///< by connection id
};

struct ConversionOutcome {
  bool complete = false;  ///< false when the observer ended it early
  std::uint64_t topics = 0;
  std::uint64_t messages = 0;
};

/// Called now and then with the record time reached; returning false ends the conversion.
using ConversionObserver = std::function<bool(Time record_time)>;

/// Writes every message of `source` to `sink`, which it closes; record times, their order and every
/// value stay, as `MessageConverter` writes them.
Result<ConversionOutcome> convert_messages(MessageSource& source, MessageSink& sink,
                                           const ConversionObserver& observer);

}  // namespace aims
