// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "recordings/bag/message_source.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {

/// Reads stamps of the connections that have one.
class MessageStamps {
 public:
  explicit MessageStamps(const std::vector<BagConnection>& connections) {
    for (const BagConnection& each : connections) {
      auto decoder = MessageDecoder::create(each.type, each.definition, each.format);
      if (decoder) decoders_.emplace(each.id, std::move(*decoder));
    }
  }

  /// That of the message, above 0.
  std::optional<Time> of(const BagMessage& message) const {
    const auto decoder = decoders_.find(message.connection->id);
    if (decoder == decoders_.end()) return std::nullopt;
    const auto view = decoder->second.decode(message.data);
    const auto stamp = view ? view->time("header.stamp") : std::nullopt;
    return stamp && *stamp > 0 ? stamp : std::nullopt;
  }

 private:
  std::map<std::uint32_t, MessageDecoder> decoders_;
};

}  // namespace aims
