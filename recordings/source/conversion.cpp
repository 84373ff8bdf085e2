// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/conversion.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <utility>

#include "recordings/messages/cdr_transcoder.hpp"

namespace aims {
namespace {

constexpr std::uint64_t kMessagesPerCall = 256;

/// A topic of the source on its way into the sink.
struct Route {
  std::uint32_t id = 0;  ///< in the sink
  std::optional<CdrTranscoder> transcoder;
};

class Converter {
 public:
  Converter(const MessageSource& source, MessageSink& sink) : source_(source), sink_(sink) {}

  Result<void> write(const BagMessage& message) {
    const BagConnection& connection = *message.connection;
    auto found = routes_.find(connection.id);
    if (found == routes_.end()) {
      auto route = route_of(connection);
      if (!route) return refuse(connection, route.error());
      found = routes_.emplace(connection.id, std::move(*route)).first;
    }
    const Route& route = found->second;
    if (!route.transcoder) return sink_.write(route.id, message.record_time, message.data);
    const auto bytes = route.transcoder->transcode(message.data);
    if (!bytes) return refuse(connection, bytes.error());
    return sink_.write(route.id, message.record_time, bytes->view());
  }

  std::uint64_t topics() const { return routes_.size(); }

 private:
  tl::unexpected<Error> refuse(const BagConnection& connection, const Error& error) const {
    return failure(
        fmt::format("{}: topic '{}': {}", source_.name(), connection.topic, error.message));
  }

  Result<Route> route_of(const BagConnection& connection) {
    const MessageType type = {connection.type, connection.md5, connection.definition,
                              connection.format};
    const Serialization from = connection.format.serialization;
    if (from == Serialization::kOther) {
      return failure("expected messages serialized as ros1 or cdr");
    }
    if (from == sink_.serialization()) {
      return Route{sink_.add_connection(connection.topic, type, connection.latching), {}};
    }
    if (from == Serialization::kCdr) {
      return failure("messages of ROS 2, which a ROS 1 bag cannot hold: expected .mcap");
    }
    auto transcoder = CdrTranscoder::create(type);
    if (!transcoder) return tl::unexpected(transcoder.error());
    const std::uint32_t id =
        sink_.add_connection(connection.topic, transcoder->type(), connection.latching);
    return Route{id, std::move(*transcoder)};
  }

  const MessageSource& source_;
  MessageSink& sink_;
  std::map<std::uint32_t, Route> routes_;  ///< by connection id
};

}  // namespace

Result<ConversionOutcome> convert_messages(MessageSource& source, MessageSink& sink,
                                           const ConversionObserver& observer) {
  ConversionOutcome outcome;
  outcome.complete = true;
  Converter converter(source, sink);
  while (outcome.complete) {
    const auto message = source.next();
    if (!message) return tl::unexpected(message.error());
    if (!*message) break;
    if (auto written = converter.write(**message); !written) {
      return tl::unexpected(written.error());
    }
    const bool ask = outcome.messages++ % kMessagesPerCall == 0;
    if (ask) outcome.complete = observer((*message)->record_time);
  }
  outcome.topics = converter.topics();
  if (auto closed = sink.close(); !closed) return tl::unexpected(closed.error());
  return outcome;
}

}  // namespace aims
