// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/recorded_metadata.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "recordings/messages/message_decoder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The metadata in the recording: the text of the first such topic.
std::optional<std::string> recorded_metadata(MessageSource& source) {
  std::optional<std::string> text;
  for (const BagConnection& each : source.connections()) {
    if (each.type != "std_msgs/String" || !each.topic.ends_with("metadata")) continue;
    source.select({&each.topic, 1});
    source.rewind();
    const auto message = source.next();
    const auto decoder = MessageDecoder::create(each.type, each.definition, each.format);
    if (!message || !*message || !decoder) continue;
    const auto view = decoder->decode((*message)->data);
    if (!view) continue;
    if (const auto data = view->text("data")) text = std::string(*data);
    if (text) break;
  }
  std::vector<std::string> all;
  for (const BagConnection& each : source.connections()) all.push_back(each.topic);
  source.select(all);
  source.rewind();
  return text;
}

}  // namespace

Result<OusterMetadata> recorded_ouster_metadata(MessageSource& source, const std::string& topic) {
  if (const auto text = recorded_metadata(source)) {
    return parse_ouster_metadata(*text, source.name() + ": metadata of the Ouster");
  }
  const fs::path beside = fs::path(source.name()).replace_extension(".json");
  std::error_code ignored;
  if (fs::exists(beside, ignored)) return read_ouster_metadata(beside);
  return failure(
      fmt::format("{}: topic '{}' holds packets of an Ouster: expected its metadata as "
                  "std_msgs/String on a topic that ends in 'metadata', or as {} beside it",
                  source.name(), topic, beside.filename().string()));
}

}  // namespace aims
