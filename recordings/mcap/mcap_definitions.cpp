// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/mcap/mcap_definitions.hpp"

#include <fmt/format.h>

#include "recordings/messages/message_definition.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/messages/quality_of_service.hpp"

namespace aims {
namespace {

MessageFormat format_of(std::string_view message_encoding, std::string_view schema_encoding) {
  MessageFormat format;
  if (message_encoding == "cdr") {
    format.serialization = Serialization::kCdr;
  } else if (message_encoding != "ros1") {
    format.serialization = Serialization::kOther;
  }
  if (schema_encoding == "ros2idl") {
    format.language = DefinitionLanguage::kRos2Idl;
  } else if (schema_encoding == "ros2msg" || message_encoding == "cdr") {
    format.language = DefinitionLanguage::kRos2Msg;
  }
  return format;
}

}  // namespace

Result<void> McapDefinitions::add(const McapRecord& record) {
  if (record.op == McapOp::kSchema) {
    const auto schema = parse_schema(record.body);
    if (!schema || schema->id == 0) return failure("expected a schema with an id above 0");
    return add_schema(*schema);
  }
  if (record.op == McapOp::kChannel) {
    const auto channel = parse_channel(record.body);
    if (!channel) return failure("expected a channel with its topic, encoding and metadata");
    return add_channel(*channel);
  }
  return {};
}

Result<void> McapDefinitions::add_schema(const McapSchema& found) {
  Schema schema{std::string(found.name), std::string(found.encoding), std::string(found.text)};
  const auto [place, added] = schemas_.try_emplace(found.id, schema);
  if (added || place->second == schema) return {};
  return failure(fmt::format("schema {} is '{}', but was announced as '{}' or with another text",
                             found.id, schema.name, place->second.name));
}

Result<void> McapDefinitions::add_channel(const McapChannel& found) {
  if (found.schema != 0 && !schemas_.contains(found.schema)) {
    return failure(fmt::format("channel {} ('{}') has schema {}, which no record announces",
                               found.id, found.topic, found.schema));
  }
  Channel channel{found.schema,
                  std::string(found.topic),
                  std::string(found.encoding),
                  std::string(found.find("offered_qos_profiles")),
                  std::string(found.find("md5sum")),
                  std::string(found.find("latching"))};
  const auto [place, added] = channels_.try_emplace(found.id, channel);
  if (added || place->second == channel) return {};
  return failure(fmt::format("channel {} is '{}', but was announced as '{}' or otherwise", found.id,
                             channel.topic, place->second.topic));
}

std::vector<BagConnection> McapDefinitions::connections() const {
  std::vector<BagConnection> connections;
  for (const auto& [id, channel] : channels_) {
    BagConnection connection;
    connection.id = id;
    connection.topic = channel.topic;
    connection.md5 = channel.md5;
    connection.latching = channel.latching == "1" || is_transient_local(channel.qos);
    const auto schema = schemas_.find(channel.schema);
    if (schema != schemas_.end()) {
      connection.type = plain_type_name(schema->second.name);
      connection.definition = schema->second.text;
      connection.format = format_of(channel.encoding, schema->second.encoding);
    } else {
      connection.format = format_of(channel.encoding, "");
    }
    complete_definition(connection.type, connection.definition, connection.format);
    connections.push_back(std::move(connection));
  }
  return connections;
}

}  // namespace aims
