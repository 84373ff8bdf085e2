// SPDX-License-Identifier: BSD-3-Clause
// Writes and lists bags for the readers and writers of others to be held against ours:
//   bag_tool write FILE none|lz4|bz2 CHUNK_BYTES [COUNT [POINTS]]   a sample of all message types
//   bag_tool list FILE [recover]                   time, topic, size and CRC of every message
//   bag_tool decode FILE                           every value of every message
//   bag_tool flood FILE                            writes until it is killed
#include <fmt/format.h>

#include <boost/crc.hpp>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "recordings/bag/bag_reader.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_layout.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

constexpr Time kStart = 1'600'000'000 * kSecond + 123;

int fail(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  return 2;
}

LidarScan sample_scan(std::mt19937& random, int points) {
  LidarScan scan;
  std::uniform_real_distribution<float> coordinate(-50.0F, 50.0F);
  for (int i = 0; i < points; ++i) {
    LidarPoint point;
    point.position = {coordinate(random), coordinate(random), coordinate(random)};
    scan.points.push_back(point);
  }
  return scan;
}

Result<void> write_sample(BagWriter& bag, int count, int points) {
  std::mt19937 random(1);
  const auto text = bag.add_connection("/aims/scenario", string_type());
  const auto cloud = bag.add_connection("/lidar/points", point_cloud_type());
  const auto imu = bag.add_connection("/imu/data", imu_type());
  const auto joints = bag.add_connection("/joint_states", joint_state_type());
  const auto contacts = bag.add_connection("/foot_contacts", foot_contacts_type());
  const auto odometry = bag.add_connection("/leg_odometry", odometry_type());
  const auto tf = bag.add_connection("/tf_static", transforms_type(), true);
  const auto silent = bag.add_connection("/silent", string_type());
  static_cast<void>(silent);
  std::uint32_t sequence = 0;
  Result<void> outcome;
  const auto put = [&](std::uint32_t connection, Time time, const MessageBytes& message) {
    if (outcome) outcome = bag.write(connection, time, message.view());
  };
  put(text, kStart, string_message("a: 1 # \xc3\xa4\n"));
  put(tf, kStart, transforms_message(kStart, {{"imu", "lidar", Pose{}}, {"imu", "base", Pose{}}}));
  for (int i = 0; i < count; ++i) {
    const Time time = kStart + i * 7 * kMillisecond;
    const MessageHeader header{sequence++, time, "some_frame"};
    ImuSample sample;
    sample.orientation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
    LegOdometrySample legs;
    OdometryContent content;
    content.pose.translation = {0.1 * i, -1.0, 1e-300};
    content.linear_velocity = {1.0, 2.0, 3.0};
    put(imu, time, imu_message(header, sample));
    put(joints, time, joint_state_message(header, legs));
    put(contacts, time, foot_contacts_message(header, legs));
    put(odometry, time, odometry_message(header, "base", content));
    // Recorded later than what follows: chunks overlap in time.
    if (i % 10 == 0)
      put(cloud, time + 100 * kMillisecond, cloud_message(header, sample_scan(random, points)));
  }
  return outcome;
}

int write(const std::vector<std::string>& words) {
  BagWriterOptions options;
  options.compression = compression_named(words[2]).value();
  options.chunk_size = std::stoul(words[3]);
  const int count = words.size() > 4 ? std::stoi(words[4]) : 200;
  const int points = words.size() > 5 ? std::stoi(words[5]) : 500;
  auto bag = BagWriter::create(words[1], options);
  if (!bag) return fail(bag.error());
  if (const auto written = write_sample(*bag, count, points); !written)
    return fail(written.error());
  if (const auto closed = bag->close(); !closed) return fail(closed.error());
  return 0;
}

int flood(const std::string& file) {
  BagWriterOptions options;
  options.chunk_size = 100'000;
  auto bag = BagWriter::create(file, options);
  if (!bag) return fail(bag.error());
  const auto connection = bag->add_connection("/flood", string_type());
  for (int i = 0; i < 10'000'000; ++i) {
    const auto message = string_message(fmt::format("{:06}{:994}", i, ""));
    const auto written = bag->write(connection, kStart + i * kMillisecond, message.view());
    if (!written) return fail(written.error());
  }
  return 0;
}

/// Calls `use` with every message; yields what went wrong.
template <class Use>
Result<void> for_each_message(const std::string& file, BagOpenOptions options, Use use) {
  auto bag = BagReader::open(file, options);
  if (!bag) return tl::unexpected(bag.error());
  while (true) {
    const auto message = bag->next();
    if (!message) return tl::unexpected(message.error());
    if (!*message) return {};
    if (const Result<void> used = use(**message); !used) return used;
  }
}

int list(const std::string& file, bool recover) {
  const auto read =
      for_each_message(file, {.recover = recover}, [](const BagMessage& message) -> Result<void> {
        boost::crc_32_type crc;
        crc.process_bytes(message.data.data(), message.data.size());
        fmt::print("{} {} {} {} {:08x}\n", message.record_time, message.connection->topic,
                   message.connection->type, message.data.size(), crc.checksum());
        return {};
      });
  return read ? 0 : fail(read.error());
}

std::string hex(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return out;
}

void print_fields(const MessageView& view, const std::vector<MessageLayout>& layouts,
                  const MessageLayout& layout, const std::string& prefix) {
  for (const FieldSlot& slot : layout.slots) {
    if (slot.is_placeholder) continue;
    const std::string path = prefix + slot.path;
    if (slot.kind == FieldKind::kMessages) {
      for (std::size_t i = 0; i < view.size(path).value(); ++i) {
        print_fields(view, layouts, layouts[slot.element], fmt::format("{}[{}].", path, i));
      }
    } else if (slot.kind == FieldKind::kNumber) {
      fmt::print("{} {:.17g}\n", path, view.number(path).value());
    } else if (slot.kind == FieldKind::kTime) {
      fmt::print("{} {}\n", path, view.time(path).value());
    } else if (slot.kind == FieldKind::kText) {
      fmt::print("{} {}\n", path, hex(view.text(path).value()));
    } else if (slot.kind == FieldKind::kNumbers) {
      fmt::print("{}", path);
      const auto values = view.numbers(path);
      for (const double value : *values) fmt::print(" {:.17g}", value);
      fmt::print("\n");
    } else if (slot.kind == FieldKind::kTexts) {
      fmt::print("{}", path);
      const auto texts = view.texts(path);
      for (const std::string_view text : *texts) fmt::print(" {}", hex(text));
      fmt::print("\n");
    } else {
      fmt::print("{}", path);
      for (std::size_t i = 0; i < view.size(path).value(); ++i) {
        fmt::print(" {}", view.time(fmt::format("{}[{}]", path, i)).value());
      }
      fmt::print("\n");
    }
  }
}

int decode(const std::string& file) {
  std::map<std::uint32_t, MessageDecoder> decoders;
  const auto read = for_each_message(file, {}, [&](const BagMessage& message) -> Result<void> {
    const BagConnection& connection = *message.connection;
    const auto layouts = message_layouts(connection.type, connection.definition);
    if (!layouts) return tl::unexpected(layouts.error());
    if (!decoders.contains(connection.id)) {
      const auto made = MessageDecoder::create(connection.type, connection.definition);
      decoders.emplace(connection.id, made.value());
    }
    const auto view = decoders.at(connection.id).decode(message.data);
    if (!view) return tl::unexpected(view.error());
    fmt::print("{} {}\n", message.record_time, connection.topic);
    print_fields(*view, *layouts, layouts->back(), "");
    return {};
  });
  return read ? 0 : fail(read.error());
}

int run(const std::vector<std::string>& words) {
  if (words.size() >= 4 && words[0] == "write") return write(words);
  if (words.size() == 2 && words[0] == "list") return list(words[1], false);
  if (words.size() == 3 && words[0] == "list") return list(words[1], words[2] == "recover");
  if (words.size() == 2 && words[0] == "decode") return decode(words[1]);
  if (words.size() == 2 && words[0] == "flood") return flood(words[1]);
  return fail(Error{"usage: bag_tool write|list|decode|flood FILE ..."});
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) { return aims::run({argv + 1, argv + argc}); }
