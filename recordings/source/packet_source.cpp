// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/packet_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/pcap/ouster_packets.hpp"
#include "recordings/pcap/packet_decoder.hpp"
#include "recordings/source/derived_source.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Whose packets a message holds.
enum class LidarMaker : std::uint8_t { kVelodyne, kHesai, kOuster, kRobosense };

/// How a message type holds packets.
struct PacketType {
  std::string_view type;
  LidarMaker maker = LidarMaker::kVelodyne;
  std::string_view packets;  ///< field of the array; empty: the message is one packet
  std::string_view data;
  std::string_view size;  ///< field of the used size of `data`; empty: all of it
};

constexpr auto kTypes = std::to_array<PacketType>({
    {"velodyne_msgs/VelodyneScan", LidarMaker::kVelodyne, "packets", "data", ""},
    {"pandar_msgs/PandarScan", LidarMaker::kHesai, "packets", "data", "size"},
    {"hesai_lidar/PandarScan", LidarMaker::kHesai, "packets", "data", "size"},
    {"hesai_ros_driver/UdpFrame", LidarMaker::kHesai, "packets", "data", "size"},
    {"rslidar_msgs/rslidarScan", LidarMaker::kRobosense, "packets", "data", ""},
    {"rslidar_msgs/rslidarPacket", LidarMaker::kRobosense, "", "data", ""},
    {"rslidar_msg/RslidarScan", LidarMaker::kRobosense, "packets", "data", ""},
    {"rslidar_msg/RslidarPacket", LidarMaker::kRobosense, "", "data", ""},
    {"ouster_ros/PacketMsg", LidarMaker::kOuster, "", "buf", ""},
    {"ouster_sensor_msgs/PacketMsg", LidarMaker::kOuster, "", "buf", ""},
});

/// Null for other types.
const PacketType* packet_type_of(std::string_view type) {
  const auto* const found = std::ranges::find(kTypes, type, &PacketType::type);
  return found == kTypes.end() ? nullptr : &*found;
}

/// A RoboSense has a topic of points, and one named like it with "difop" of information: the topic
/// of the points that a topic of information belongs to; itself, if it has points.
std::string topic_of_points(const std::string& topic) {
  const std::size_t at = topic.find("difop");
  return at == std::string::npos || at == 0 ? topic : topic.substr(0, at - 1);
}

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
  start_anew(source);
  return text;
}

/// The metadata of an Ouster whose packets are on `topic`: a std_msgs/String of a topic that ends
/// in "metadata", else NAME.json beside the recording. Rewinds it. Error for neither.
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

/// A topic of packets.
struct Stream {
  const PacketType* type = nullptr;
  std::string frame;
  MessageDecoder message;
  std::shared_ptr<PacketDecoder> packets;  ///< that of an Ouster serves both of its topics
  PacketKind kind = kScan;
  std::uint32_t made = 0;                ///< connection of what the packets become
  std::optional<std::uint32_t> informs;  ///< the stream of points that these packets describe
  std::vector<std::byte> early;          ///< the last packet of information before the points
};

/// Whether the packets of a topic describe the points of another one.
bool is_information(const BagConnection& packets) {
  return packet_type_of(packets.type)->maker == LidarMaker::kRobosense &&
         topic_of_points(packets.topic) != packets.topic;
}

/// Nothing for a topic without packets that can be read.
std::optional<Stream> stream_of(const BagConnection& packets) {
  const PacketType* type = packet_type_of(packets.type);
  if (type == nullptr || packets.messages == 0) return std::nullopt;
  auto decoder = MessageDecoder::create(packets.type, packets.definition, packets.format);
  if (!decoder) return std::nullopt;
  Stream stream;
  stream.type = type;
  stream.message = std::move(*decoder);
  return stream;
}

/// A recording with what its packets become.
class PacketSource final : public DerivedSource {
 public:
  PacketSource(std::unique_ptr<MessageSource> source, std::optional<OusterMetadata> ouster)
      : DerivedSource(std::move(source)), ouster_(std::move(ouster)) {
    const std::vector<BagConnection> recorded = connections_;
    for (const BagConnection& each : recorded) {
      auto stream = stream_of(each);
      if (stream && !is_information(each)) add_stream(each, *std::move(stream), recorded);
    }
    if (ouster_) {
      frames_ = add_topic("/tf_static", transforms_type(), recorded.front().messages, {});
    }
    restart();
  }

 private:
  void add_stream(const BagConnection& packets, Stream stream,
                  const std::vector<BagConnection>& recorded) {
    std::map<std::uint32_t, Stream> information;
    std::set<std::uint32_t> from = {packets.id};
    for (const BagConnection& each : recorded) {
      auto informing = stream_of(each);
      if (!informing || !is_information(each)) continue;
      if (topic_of_points(each.topic) != packets.topic) continue;
      from.insert(each.id);
      informing->informs = packets.id;
      information.emplace(each.id, *std::move(informing));
    }
    // An Ouster has a topic each for LiDAR and IMU, told apart by the size of their packets.
    const bool imu =
        stream.type->maker == LidarMaker::kOuster && packets.topic.find("imu") != std::string::npos;
    stream.kind = imu ? kImu : kScan;
    stream.made = add_topic(packets.topic + (imu ? "/imu" : "/points"),
                            imu ? imu_type() : point_cloud_type(), packets.messages, from);
    streams_.emplace(packets.id, std::move(stream));
    streams_.merge(information);
  }

  /// Decoders as at the start of the recording.
  void restart() override {
    finished_ = false;
    const std::shared_ptr<PacketDecoder> ouster =
        ouster_ ? std::shared_ptr<PacketDecoder>(ouster_decoder(*ouster_, false)) : nullptr;
    for (auto& [id, stream] : streams_) {
      stream.packets = stream.type->maker == LidarMaker::kOuster ? ouster : nullptr;
      stream.early.clear();
    }
    const Time start = summary().start;
    if (ouster_) give(frames_, start, ouster_frames(*ouster_, start));
  }

  void keep(const Stream& stream, std::optional<PacketMessage> made, Time time) {
    if (made && made->kind == stream.kind) give(stream.made, time, std::move(made->bytes));
  }

  static std::shared_ptr<PacketDecoder> decoder_of(const Stream& stream) {
    const std::string frame = stream.frame.empty() ? "lidar" : stream.frame;
    if (stream.type->maker == LidarMaker::kVelodyne) return velodyne_decoder(frame);
    if (stream.type->maker == LidarMaker::kHesai) return hesai_decoder(frame);
    auto decoder = robosense_decoder(frame);
    static_cast<void>(decoder->add({0, stream.early, 0}));
    return decoder;
  }

  /// Packets of information complete no scan.
  static Result<void> inform(Stream& points, std::span<const std::byte> payload) {
    if (points.packets) static_cast<void>(points.packets->add({0, payload, 0}));
    if (!points.packets) points.early.assign(payload.begin(), payload.end());
    return {};
  }

  Result<void> add(Stream& stream, const MessageView& packet, Time record_time, Time stamp) {
    auto payload = packet.bytes(stream.type->data);
    if (!payload) return {};
    const auto size = packet.number(stream.type->size);
    if (size && *size >= 0.0 && *size < static_cast<double>(payload->size())) {
      payload = payload->first(static_cast<std::size_t>(*size));
    }
    if (stream.informs) return inform(streams_.at(*stream.informs), *payload);
    if (!stream.packets) stream.packets = decoder_of(stream);
    auto made = stream.packets->add({stamp, *payload, 0});
    if (!made) return tl::unexpected(made.error());
    keep(stream, std::move(*made), record_time);
    return {};
  }

  Result<void> see(const BagMessage& message) override {
    Stream& stream = streams_.at(message.connection->id);
    const auto view = stream.message.decode(message.data);
    if (!view) return {};  // counted where it is read
    if (stream.frame.empty()) stream.frame = view->text("header.frame_id").value_or("");
    const auto refuse = [&](const Result<void>& added) {
      return failure(fmt::format("{}: topic '{}': {}", name(), message.connection->topic,
                                 added.error().message));
    };
    if (stream.type->packets.empty()) {
      const auto added = add(stream, *view, message.record_time, message.record_time);
      return added ? added : refuse(added);
    }
    const auto packets = view->messages(stream.type->packets);
    for (const MessageView& each : packets.value_or(std::vector<MessageView>())) {
      const Time stamp = each.time("stamp").value_or(message.record_time);
      const auto added = add(stream, each, message.record_time, stamp);
      if (!added) return refuse(added);
    }
    return {};
  }

  /// The scans that the recording ends in.
  void finish(Time last) override {
    if (std::exchange(finished_, true)) return;
    for (auto& [id, stream] : streams_) {
      if (stream.packets && stream.kind == kScan) keep(stream, stream.packets->finish(), last);
    }
  }

  std::optional<OusterMetadata> ouster_;
  std::map<std::uint32_t, Stream> streams_;  ///< by connection
  std::uint32_t frames_ = 0;
  bool finished_ = false;
};

}  // namespace

Result<void> decode_packets(std::unique_ptr<MessageSource>& source) {
  std::optional<OusterMetadata> ouster;
  bool packets = false;
  for (const BagConnection& each : source->connections()) {
    const PacketType* type = packet_type_of(each.type);
    if (type == nullptr || each.messages == 0) continue;
    packets = true;
    if (type->maker != LidarMaker::kOuster || ouster) continue;
    auto metadata = recorded_ouster_metadata(*source, each.topic);
    if (!metadata) return tl::unexpected(metadata.error());
    ouster = std::move(*metadata);
  }
  if (packets) source = std::make_unique<PacketSource>(std::move(source), std::move(ouster));
  return {};
}

}  // namespace aims
