// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/conversion.hpp"

#include <fmt/format.h>

#include <utility>

namespace aims {
namespace {

constexpr std::uint64_t kMessagesPerCall = 256;

}  // namespace

MessageConverter::MessageConverter(std::string source, MessageSink& sink)
    : source_(std::move(source)), sink_(sink) {}

Result<void> MessageConverter::write(const BagMessage& message) {
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

tl::unexpected<Error> MessageConverter::refuse(const BagConnection& connection,
                                               const Error& error) const {
  return failure(fmt::format("{}: topic '{}': {}", source_, connection.topic, error.message));
}

Result<MessageConverter::Route> MessageConverter::route_of(const BagConnection& connection) {
  const MessageType type = {connection.type, connection.md5, connection.definition,
                            connection.format};
  const Serialization from = connection.format.serialization;
  if (from == Serialization::kOther) return failure("expected messages serialized as ros1 or cdr");
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

Result<ConversionOutcome> convert_messages(MessageSource& source, MessageSink& sink,
                                           const ConversionObserver& observer) {
  ConversionOutcome outcome;
  outcome.complete = true;
  MessageConverter converter(source.name(), sink);
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
