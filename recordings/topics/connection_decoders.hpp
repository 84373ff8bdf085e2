// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {

/// Decodes the messages of any connection, with one decoder per connection.
class ConnectionDecoders {
 public:
  /// Error for a definition that cannot be parsed or bytes that contradict it.
  Result<MessageView> decode(const BagMessage& message) {
    const BagConnection& connection = *message.connection;
    auto found = decoders_.find(connection.id);
    if (found == decoders_.end()) {
      auto decoder =
          MessageDecoder::create(connection.type, connection.definition, connection.format);
      found = decoders_.emplace(connection.id, std::move(decoder)).first;
    }
    if (!found->second) return tl::unexpected(found->second.error());
    return found->second->decode(message.data);
  }

 private:
  std::map<std::uint32_t, Result<MessageDecoder>> decoders_;  ///< by connection id
};

}  // namespace aims
