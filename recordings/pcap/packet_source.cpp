// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/packet_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
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
  std::vector<std::string> all;
  for (const BagConnection& each : source.connections()) all.push_back(each.topic);
  source.select(all);
  source.rewind();
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

constexpr std::string_view kFramesTopic = "/tf_static";

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

/// A recording with what its packets become.
class PacketSource final : public MessageSource {
 public:
  PacketSource(std::unique_ptr<MessageSource> source, std::optional<OusterMetadata> ouster)
      : source_(std::move(source)),
        ouster_(std::move(ouster)),
        connections_(source_->connections()) {
    for (const BagConnection& each : connections_) recorded_.insert(each.id);
    const std::vector<BagConnection> recorded = connections_;
    for (const BagConnection& each : recorded) add_stream(each);
    attach_information();
    if (ouster_) frames_ = add_connection(recorded.front(), kFramesTopic, transforms_type());
    for (const BagConnection& each : connections_) wanted_.insert(each.id);
    restart();
  }

  std::string name() const override { return source_->name(); }
  const std::vector<BagConnection>& connections() const override { return connections_; }
  const BagSummary& summary() const override { return source_->summary(); }

  void select(std::span<const std::string> topics) override {
    wanted_.clear();
    std::set<std::string> needed;
    for (const BagConnection& each : connections_) {
      if (std::ranges::find(topics, each.topic) == topics.end()) continue;
      wanted_.insert(each.id);
      if (recorded_.contains(each.id)) needed.insert(each.topic);
    }
    for (const auto& [id, stream] : streams_) {
      if (wanted_.contains(stream.made)) needed.insert(connection(id)->topic);
    }
    source_->select(std::vector<std::string>(needed.begin(), needed.end()));
  }

  Result<std::optional<BagMessage>> next() override {
    while (true) {
      if (auto made = take()) return made;
      if (ended_) return std::optional<BagMessage>();
      auto message = source_->next();
      if (!message) return message;
      if (!*message) {
        finish();
        continue;
      }
      last_time_ = (*message)->record_time;
      const std::uint32_t id = (*message)->connection->id;
      const auto stream = streams_.find(id);
      if (stream != streams_.end()) {
        if (auto decoded = decode(stream->second, **message); !decoded) {
          return tl::unexpected(decoded.error());
        }
      }
      if (!wanted_.contains(id)) continue;
      BagMessage same = **message;
      same.connection = connection(id);
      return std::optional<BagMessage>(same);
    }
  }

  void rewind() override {
    source_->rewind();
    restart();
  }

 private:
  struct Made {
    std::uint32_t id = 0;
    Time time = 0;
    MessageBytes bytes;
  };

  const BagConnection* connection(std::uint32_t id) const {
    return &*std::ranges::find(connections_, id, &BagConnection::id);
  }

  std::uint32_t add_connection(const BagConnection& packets, std::string_view topic,
                               const MessageType& type) {
    std::uint32_t id = 0;
    for (const BagConnection& each : connections_) id = std::max(id, each.id + 1);
    BagConnection added;
    added.id = id;
    added.topic = topic;
    added.type = type.name;
    added.md5 = type.md5;
    added.definition = type.definition;
    // Where the recording has such a topic, that is chosen unless this one is named.
    const bool recorded = std::ranges::any_of(connections_, [&](const BagConnection& each) {
      return recorded_.contains(each.id) && each.type == type.name && each.messages > 0;
    });
    added.messages = recorded && topic != kFramesTopic ? 0 : packets.messages;
    connections_.push_back(std::move(added));
    return id;
  }

  void add_stream(const BagConnection& packets) {
    const PacketType* type = packet_type_of(packets.type);
    if (type == nullptr || packets.messages == 0) return;
    auto decoder = MessageDecoder::create(packets.type, packets.definition, packets.format);
    if (!decoder) return;
    Stream stream;
    stream.type = type;
    stream.message = std::move(*decoder);
    // An Ouster has a topic each for LiDAR and IMU, told apart by the size of their packets.
    const bool imu =
        type->maker == LidarMaker::kOuster && packets.topic.find("imu") != std::string::npos;
    if (type->maker == LidarMaker::kRobosense && topic_of_points(packets.topic) != packets.topic) {
      information_.emplace(packets.id, std::move(stream));
      return;
    }
    stream.kind = imu ? kImu : kScan;
    stream.made = add_connection(packets, packets.topic + (imu ? "/imu" : "/points"),
                                 imu ? imu_type() : point_cloud_type());
    streams_.emplace(packets.id, std::move(stream));
  }

  /// Makes the packets of information go to the decoder of their points.
  void attach_information() {
    for (auto& [id, stream] : information_) {
      const std::string points = topic_of_points(connection(id)->topic);
      const auto found = std::ranges::find_if(
          streams_, [&](const auto& each) { return connection(each.first)->topic == points; });
      if (found == streams_.end()) continue;
      stream.made = found->second.made;
      stream.informs = found->first;
      streams_.emplace(id, std::move(stream));
    }
  }

  /// Decoders as at the start of the recording.
  void restart() {
    made_.clear();
    lent_.reset();
    ended_ = false;
    last_time_ = summary().start;
    const std::shared_ptr<PacketDecoder> ouster =
        ouster_ ? std::shared_ptr<PacketDecoder>(ouster_decoder(*ouster_, false)) : nullptr;
    for (auto& [id, stream] : streams_) {
      stream.packets = stream.type->maker == LidarMaker::kOuster ? ouster : nullptr;
      stream.early.clear();
    }
    if (ouster_)
      made_.push_back({frames_, summary().start, ouster_frames(*ouster_, summary().start)});
  }

  /// The next message that is made, if it is wanted.
  std::optional<BagMessage> take() {
    while (!made_.empty()) {
      lent_ = std::move(made_.front());
      made_.pop_front();
      if (!wanted_.contains(lent_->id)) continue;
      return BagMessage{connection(lent_->id), lent_->time, lent_->bytes.view(), 0};
    }
    return std::nullopt;
  }

  void keep(const Stream& stream, std::optional<PacketMessage> made, Time time) {
    if (made && made->kind == stream.kind) {
      made_.push_back({stream.made, time, std::move(made->bytes)});
    }
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

  Result<void> decode(Stream& stream, const BagMessage& message) {
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
  void finish() {
    ended_ = true;
    for (auto& [id, stream] : streams_) {
      if (stream.packets && stream.kind == kScan) {
        keep(stream, stream.packets->finish(), last_time_);
      }
    }
  }

  std::unique_ptr<MessageSource> source_;
  std::optional<OusterMetadata> ouster_;
  std::vector<BagConnection> connections_;
  std::set<std::uint32_t> recorded_;         ///< connections of the recording itself
  std::set<std::uint32_t> wanted_;           ///< connections that are given
  std::map<std::uint32_t, Stream> streams_;  ///< by connection
  std::map<std::uint32_t, Stream> information_;
  std::uint32_t frames_ = 0;
  std::deque<Made> made_;
  std::optional<Made> lent_;  ///< that the caller has
  Time last_time_ = 0;
  bool ended_ = false;
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
