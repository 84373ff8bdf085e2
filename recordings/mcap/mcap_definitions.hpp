// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"
#include "recordings/mcap/mcap_records.hpp"

namespace aims {

/// The schemas and channels of an MCAP file, by their ids.
class McapDefinitions {
 public:
  /// Adds a schema or a channel; other records are ignored. A repetition is accepted; a different
  /// record of the same id is an error, as is a channel of a schema that is not yet known.
  Result<void> add(const McapRecord& record);
  bool contains(std::uint32_t channel) const { return channels_.contains(channel); }
  /// The channels as connections, without message counts.
  std::vector<BagConnection> connections() const;

 private:
  struct Schema {
    std::string name, encoding, text;
    bool operator==(const Schema&) const = default;
  };
  struct Channel {
    std::uint16_t schema = 0;
    std::string topic, encoding, qos, md5, latching;
    bool operator==(const Channel&) const = default;
  };
  Result<void> add_schema(const McapSchema& schema);
  Result<void> add_channel(const McapChannel& channel);

  std::map<std::uint32_t, Schema> schemas_;
  std::map<std::uint32_t, Channel> channels_;
};

}  // namespace aims
