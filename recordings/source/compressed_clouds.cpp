// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/compressed_clouds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/files/inflate.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/messages/message_values.hpp"
#include "recordings/rosbag2/zstd_frame.hpp"
#include "recordings/source/derived_source.hpp"

namespace aims {
namespace {

constexpr std::size_t kLargestCloud = std::size_t{1} << 28;  ///< of a cloud's points [bytes]

bool is_compressed(const BagConnection& connection) {
  return connection.type.ends_with("/CompressedPointCloud2") && connection.messages > 0;
}

bool is_zlib(std::string_view format) { return format == "zlib"; }
bool is_read(std::string_view format) { return is_zlib(format) || format == "zstd"; }

std::uint32_t whole_number(const MessageView& view, std::string_view path) {
  return static_cast<std::uint32_t>(std::clamp(view.number(path).value_or(0.0), 0.0, 4e9));
}

Result<std::vector<std::byte>> unpacked(const MessageView& view, std::string_view format) {
  const auto packed = view.bytes("compressed_data");
  if (!packed) return failure("expected compressed_data");
  const auto size =
      static_cast<std::size_t>(whole_number(view, "row_step")) * whole_number(view, "height");
  const std::size_t limit = std::min(size, kLargestCloud);
  Result<std::vector<std::byte>> points = std::vector<std::byte>();
  if (is_zlib(format)) {
    points = inflate(*packed, limit);
  } else if (const auto done = unpack_frame(*packed, limit, *points); !done) {
    return tl::unexpected(done.error());
  }
  if (points && points->size() != size) {
    return failure(fmt::format("expected {} bytes of points, found {}", size, points->size()));
  }
  return points;
}

/// sensor_msgs/PointCloud2 of the same cloud; without points where they could not be unpacked.
MessageBytes raw_cloud(const MessageView& view, const std::vector<std::byte>& points) {
  MessageBytes out;
  out.reserve(points.size() + 500);
  out.put(std::uint32_t{0});
  out.time(std::max(Time{0}, view.time("header.stamp").value_or(0)));
  out.text(view.text("header.frame_id").value_or(""));
  const bool empty = points.empty();
  out.put(empty ? 0U : whole_number(view, "height"));
  out.put(empty ? 0U : whole_number(view, "width"));
  const auto fields = view.messages("fields").value_or(std::vector<MessageView>());
  out.length(fields.size());
  for (const MessageView& field : fields) {
    out.text(field.text("name").value_or(""));
    out.put(whole_number(field, "offset"));
    out.put(static_cast<std::uint8_t>(whole_number(field, "datatype")));
    out.put(whole_number(field, "count"));
  }
  out.put(static_cast<std::uint8_t>(whole_number(view, "is_bigendian")));
  out.put(whole_number(view, "point_step"));
  out.put(empty ? 0U : whole_number(view, "row_step"));
  out.length(points.size());
  out.append(points.data(), points.size());
  out.put(static_cast<std::uint8_t>(whole_number(view, "is_dense")));
  return out;
}

class CompressedClouds final : public DerivedSource {
 public:
  CompressedClouds(std::unique_ptr<MessageSource> source, BagConnection clouds,
                   MessageDecoder decoder)
      : DerivedSource(std::move(source)),
        clouds_(std::move(clouds)),
        decoder_(std::move(decoder)),
        made_(add_topic(clouds_.topic + "/points", point_cloud_type(), clouds_.messages,
                        {clouds_.id})) {}

 private:
  Result<void> see(const BagMessage& message) override {
    if (message.connection->topic != clouds_.topic) return {};
    const auto view = decoder_.decode(message.data);
    if (!view) return {};  // counted where it is read
    // A damaged cloud becomes an empty one, which is counted where it is read.
    const auto points = unpacked(*view, view->text("format").value_or(""));
    give(made_, message.record_time, raw_cloud(*view, points.value_or(std::vector<std::byte>())));
    return {};
  }

  BagConnection clouds_;
  MessageDecoder decoder_;
  std::uint32_t made_;
};

/// The format of the first cloud of the topic.
std::string format_of(MessageSource& source, const BagConnection& clouds,
                      const MessageDecoder& decoder) {
  source.select({&clouds.topic, 1});
  source.rewind();
  const auto message = source.next();
  std::string format;
  if (message && *message) {
    const auto view = decoder.decode((*message)->data);
    if (view) format = std::string(view->text("format").value_or(""));
  }
  start_anew(source);
  return format;
}

}  // namespace

Result<void> unpack_clouds(std::unique_ptr<MessageSource>& source) {
  const std::vector<BagConnection> all = source->connections();
  const bool others = std::ranges::any_of(all, [](const BagConnection& each) {
    return each.messages > 0 &&
           (each.type == "sensor_msgs/PointCloud2" || each.type.ends_with("/CustomMsg"));
  });
  for (const BagConnection& each : all) {
    if (!is_compressed(each)) continue;
    auto decoder = MessageDecoder::create(each.type, each.definition, each.format);
    if (!decoder) continue;
    const std::string format = format_of(*source, each, *decoder);
    if (is_read(format)) {
      source = std::make_unique<CompressedClouds>(std::move(source), each, std::move(*decoder));
    } else if (!others) {
      return failure(
          fmt::format("{}: topic '{}' holds clouds compressed by '{}'; read are zlib and zstd: "
                      "record them again through `ros2 run point_cloud_transport republish`",
                      source->name(), each.topic, format));
    }
  }
  return {};
}

}  // namespace aims
