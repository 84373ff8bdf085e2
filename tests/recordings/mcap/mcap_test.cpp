// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <rapidcheck.h>
// rapidcheck's gtest glue needs both headers above it.
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "core/files/crc32.hpp"
#include "recordings/clouds/point_table.hpp"
#include "recordings/mcap/mcap_reader.hpp"
#include "recordings/mcap/mcap_record_builder.hpp"
#include "recordings/mcap/mcap_writer.hpp"
#include "recordings/messages/message_bytes.hpp"
#include "recordings/messages/quality_of_service.hpp"
#include "recordings/messages/ros2_definition.hpp"
#include "recordings/source/conversion.hpp"
#include "recordings/topics/connection_decoders.hpp"
#include "tests/recordings/bag/bag_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

class Mcap : public testing::Test {
 protected:
  fs::path path(const std::string& name = "r.mcap") const { return folder_.path() / name; }

  /// The bytes of a file of `few_messages`.
  std::string sample(BagWriterOptions options = {BagCompression::kNone, 250}) const {
    fs::remove(path());
    write_bag<McapWriter>(path(), few_messages(), options);
    return read_file(path()).value();
  }

  ReadOutcome read(const std::string& bytes, BagOpenOptions options = {}) const {
    EXPECT_TRUE(put_file(path(), bytes));
    return read_all<McapReader>(path(), options);
  }

  void expect_error(const std::string& bytes, const std::string& expected) const {
    const std::string error = read(bytes).error;
    EXPECT_NE(error.find(expected), std::string::npos) << error;
    EXPECT_TRUE(error.starts_with(path().string() + ": at byte ")) << error;
  }

  TemporaryFolder folder_;
};

/// A file of these records between header and footer, without a summary.
std::string file_of(const std::vector<std::byte>& records) {
  std::vector<std::byte> bytes;
  McapRecordBuilder(bytes, McapOp::kHeader).text("ros2").text("a test").finish();
  append(bytes, records);
  McapRecordBuilder(bytes, McapOp::kDataEnd).number(std::uint32_t{0}).finish();
  McapRecordBuilder(bytes, McapOp::kFooter)
      .number(std::uint64_t{0})
      .number(std::uint64_t{0})
      .number(std::uint32_t{0})
      .finish();
  return std::string(kMcapMagic) + std::string(as_text(bytes)) + std::string(kMcapMagic);
}

/// Schema 1, channel 1 on "/a" and a message at 5 ns.
std::vector<std::byte> three_records(std::string_view encoding = "cdr") {
  std::vector<std::byte> out;
  McapRecordBuilder(out, McapOp::kSchema)
      .number(std::uint16_t{1})
      .text("std_msgs/msg/String")
      .text("ros2msg")
      .text("string data\n")
      .finish();
  McapRecordBuilder(out, McapOp::kChannel)
      .number(std::uint16_t{1})
      .number(std::uint16_t{1})
      .text("/a")
      .text(encoding)
      .entries({})
      .finish();
  McapRecordBuilder(out, McapOp::kMessage)
      .number(std::uint16_t{1})
      .number(std::uint32_t{0})
      .number(std::uint64_t{5})
      .number(std::uint64_t{5})
      .bytes(bytes_of("payload"))
      .finish();
  return out;
}

TEST(Crc32, HasTheCheckValueOfItsDefinition) {
  EXPECT_EQ(crc32_of(bytes_of("123456789")), 0xcbf43926U);
  Crc32 parts;
  parts.add(bytes_of("12345678901"));
  parts.add(bytes_of("2345"));
  EXPECT_EQ(parts.value(), crc32_of(bytes_of("123456789012345")));
}

RC_GTEST_PROP(McapRoundTrip, KeepsEveryMessageInOrderOfTime, ()) {
  const TemporaryFolder folder;
  BagWriterOptions options;
  options.compression =
      *rc::gen::element(BagCompression::kNone, BagCompression::kLz4, BagCompression::kZstd);
  options.chunk_size = *rc::gen::inRange<std::size_t>(1, 2000);
  std::vector<SampleMessage> messages;
  const int count = *rc::gen::inRange(0, 60);
  for (int i = 0; i < count; ++i) {
    const std::string size(*rc::gen::inRange<std::size_t>(0, 300), 'x');
    messages.push_back({*rc::gen::element<std::string>("/a", "/b", "/c"),
                        *rc::gen::inRange<Time>(0, 20), std::to_string(i) + size});
  }
  const fs::path file = folder.path() / "r.mcap";
  write_bag<McapWriter>(file, messages, options);
  const ReadOutcome read = read_all<McapReader>(file);
  std::ranges::stable_sort(messages, {}, &SampleMessage::time);
  RC_ASSERT(read.error == "");
  RC_ASSERT(read.messages == messages);
  RC_ASSERT(read.summary.messages == messages.size());
  RC_ASSERT(read_all<McapReader>(file, {.recover = true}).messages == messages);
}

TEST_F(Mcap, ConnectionsHaveTypeCountAndLatching) {
  auto writer = McapWriter::create(path());
  ASSERT_TRUE(writer) << writer.error().message;
  const auto imu = ros2_type(imu_type());
  const auto a = writer->add_connection("/a", *imu, false);
  const auto b = writer->add_connection("/b", *imu, true);
  ASSERT_TRUE(writer->write(b, 7, bytes_of("1")));
  ASSERT_TRUE(writer->write(b, 8, bytes_of("2")));
  ASSERT_TRUE(writer->write(a, 9, bytes_of("3")));
  EXPECT_FALSE(writer->write(9, 9, bytes_of("")));
  EXPECT_FALSE(writer->write(a, -1, bytes_of("")));
  ASSERT_TRUE(writer->close());
  EXPECT_FALSE(writer->write(a, 10, bytes_of("")));
  auto reader = McapReader::open(path());
  ASSERT_TRUE(reader) << reader.error().message;
  const auto& connections = reader->connections();
  ASSERT_EQ(connections.size(), 2U);
  EXPECT_EQ(connections[0].type, "sensor_msgs/Imu");
  EXPECT_EQ(connections[0].definition, imu->definition);
  EXPECT_EQ(connections[0].format, kRos2Format);
  EXPECT_EQ(connections[0].messages, 1U);
  EXPECT_EQ(connections[1].messages, 2U);
  EXPECT_FALSE(connections[0].latching);
  EXPECT_TRUE(connections[1].latching);
  EXPECT_TRUE(is_transient_local("- depth: 1\n  durability: transient_local\n  x: 2"));
  EXPECT_FALSE(is_transient_local("- durability: volatile"));
  reader->select(std::vector<std::string>{"/a"});
  EXPECT_EQ(as_text((**reader->next()).data), "3");
  EXPECT_FALSE(*reader->next());
}

TEST_F(Mcap, AFileWithoutSummaryIsScanned) {
  const std::string bytes = sample({BagCompression::kLz4, 250});
  // The footer of another file: no summary.
  const std::string footer = file_of({}).substr(file_of({}).size() - 37);
  const ReadOutcome scanned = read(bytes.substr(0, bytes.size() - 37) + footer);
  EXPECT_EQ(scanned.error, "");
  EXPECT_FALSE(scanned.summary.indexed);
  EXPECT_EQ(scanned.messages, few_messages());
  EXPECT_EQ(scanned.summary.messages, few_messages().size());
}

TEST_F(Mcap, MessagesOutsideChunksAreRead) {
  const std::vector<std::byte> records = three_records();
  ReadOutcome outcome = read(file_of(records));
  EXPECT_EQ(outcome.error, "");
  EXPECT_EQ(outcome.messages, (std::vector<SampleMessage>{{"/a", 5, "payload"}}));
  // Behind the chunks of an indexed file too, before the end of its data.
  auto message = std::string(as_text(records));
  message = message.substr(message.size() - 9 - 22 - 7);
  std::string bytes = sample();
  const std::size_t end = bytes.find(std::string("\x0f\x04\0\0\0\0\0\0\0", 9));
  bytes.insert(end, message);
  std::uint64_t summary = end + message.size() + 13;
  std::memcpy(bytes.data() + bytes.size() - 28, &summary, sizeof(summary));
  std::memset(bytes.data() + bytes.size() - 12, 0, 4);  // the checksum: not stated
  outcome = read(bytes);
  EXPECT_EQ(outcome.error, "");
  EXPECT_EQ(outcome.messages.size(), few_messages().size() + 1);
  EXPECT_EQ(outcome.messages.front().bytes, "payload");
}

TEST_F(Mcap, RecoversTheIntactChunksOfEveryTruncatedFile) {
  for (const BagCompression compression : {BagCompression::kNone, BagCompression::kZstd}) {
    const std::string bytes = sample({compression, 250});
    const std::vector<SampleMessage> messages = few_messages();
    std::size_t most = 0;
    for (std::size_t size = 40; size < bytes.size(); size += 7) {
      const ReadOutcome refused = read(bytes.substr(0, size));
      EXPECT_NE(refused.error.find("at byte " + std::to_string(size)), std::string::npos)
          << refused.error;
      const ReadOutcome recovered = read(bytes.substr(0, size), {.recover = true});
      EXPECT_EQ(recovered.error, "");
      const std::string advice =
          recovered.messages.empty() ? "; no chunk of it is intact" : "; --recover reads";
      EXPECT_NE(refused.error.find("never closed or is truncated" + advice), std::string::npos)
          << refused.error;
      EXPECT_EQ(refused.kind == ErrorKind::kRecoverable, !recovered.messages.empty());
      EXPECT_GE(recovered.messages.size(), most);
      most = recovered.messages.size();
      EXPECT_TRUE(
          std::equal(recovered.messages.begin(), recovered.messages.end(), messages.begin()));
    }
    EXPECT_EQ(most, messages.size());
  }
}

TEST_F(Mcap, RecoverySkipsAndCountsADamagedChunk) {
  std::string bytes = sample();
  const std::size_t inside = bytes.find("message 5");
  bytes[inside] = 'M';
  expect_error(bytes, "expected a chunk with checksum ");
  const ReadOutcome recovered = read(bytes, {.recover = true});
  EXPECT_EQ(recovered.error, "");
  EXPECT_GT(recovered.messages.size(), 6U);
  EXPECT_LT(recovered.messages.size(), few_messages().size());
  EXPECT_GT(recovered.summary.lost_bytes, 0U);
}

TEST_F(Mcap, RecoveryGoesOnBehindAHole) {
  const std::string whole = sample();
  std::string bytes = whole;
  const std::size_t from = bytes.find("message 5");
  for (const char filling : {'\0', '\xff', '\x06'}) {
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(from),
              bytes.begin() + static_cast<std::ptrdiff_t>(from + 300), filling);
    const ReadOutcome recovered = read(bytes, {.recover = true});
    EXPECT_EQ(recovered.error, "");
    ASSERT_FALSE(recovered.messages.empty());
    EXPECT_EQ(recovered.messages.back(), few_messages().back()) << "behind the hole";
    EXPECT_GT(recovered.summary.lost_bytes, 300U);
    EXPECT_LT(recovered.summary.lost_bytes, whole.size() / 2);
  }
}

TEST_F(Mcap, ErrorsNameTheByteAndWhatWasExpected) {
  expect_error("\x89MCAP1\r\n and more", "expected an MCAP file of version 0, found");
  expect_error("", "found ''");
  std::string bytes = sample();
  bytes[bytes.rfind("/b")] = '|';
  expect_error(bytes, "expected a summary with checksum ");
  expect_error(file_of(three_records()).replace(8, 1, "\x05"), "expected the header, found");
  std::vector<std::byte> records = three_records();
  records[9] = std::byte{2};  // the schema's id
  expect_error(file_of(records), "channel 1 ('/a') has schema 1, which no record announces");
  records = three_records();
  records[records.size() - 7 - 22] = std::byte{3};
  expect_error(file_of(records), "a message of channel 3, which no record announces");
  records = three_records();
  records[records.size() - 7 - 8 - 1] = std::byte{0xff};
  expect_error(file_of(records), "expected a log time below 2^63 ns");
  records = three_records();
  append(records, three_records("ros1"));
  expect_error(file_of(records), "channel 1 is '/a', but was announced as '/a' or otherwise");
}

TEST_F(Mcap, ChunksThatClaimTooMuchAreRefused) {
  const auto chunk = [](std::uint64_t size, std::string_view compression, std::uint64_t packed) {
    std::vector<std::byte> out;
    McapRecordBuilder(out, McapOp::kChunk)
        .number(std::uint64_t{0})
        .number(std::uint64_t{9})
        .number(size)
        .number(std::uint32_t{0})
        .text(compression)
        .number(packed)
        .bytes(bytes_of("0123456789"))
        .finish();
    return file_of(out);
  };
  expect_error(chunk(10, "bz2", 10), "expected compression lz4, zstd or none, found 'bz2'");
  expect_error(chunk(1 << 20, "lz4", 10), "cannot be packed into 10 bytes (lz4)");
  expect_error(chunk(11, "", 10), "cannot be packed into 10 bytes (none)");
  expect_error(chunk(std::uint64_t{1} << 40, "zstd", 10), "cannot be packed");
  expect_error(chunk(10, "", 11), "as many bytes of records as it states");
  expect_error(chunk(std::uint64_t{2} << 30, "zstd", 10), "bytes of memory, more than");
  expect_error(chunk(10, "zstd", 10), "zstd: ");
  expect_error(chunk(10, "", 10), "in this chunk, at byte 0 of its content: expected ");
}

TEST_F(Mcap, MessagesOfOtherEncodingsAreListedAndNotDecoded) {
  ASSERT_TRUE(put_file(path(), file_of(three_records("protobuf"))));
  auto reader = McapReader::open(path());
  ASSERT_TRUE(reader) << reader.error().message;
  const auto message = reader->next();
  ASSERT_TRUE(message && *message);
  const auto view = ConnectionDecoders().decode(**message);
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().message, "std_msgs/String: expected messages serialized as ros1 or cdr");
}

TEST(McapDefinitions, AUsualTypeWithoutDefinitionGetsTheBuiltInOne) {
  MessageFormat format{Serialization::kCdr, DefinitionLanguage::kRos2Idl};
  std::string definition;
  complete_definition("sensor_msgs/Imu", definition, format);
  EXPECT_EQ(format.language, DefinitionLanguage::kRos2Msg);
  EXPECT_EQ(definition, known_ros2_type("sensor_msgs/Imu")->definition);
  std::string own = "module sensor_msgs { module msg { struct Imu { long x; }; }; };";
  format.language = DefinitionLanguage::kRos2Idl;
  complete_definition("sensor_msgs/Imu", own, format);
  EXPECT_EQ(format.language, DefinitionLanguage::kRos2Idl);
  EXPECT_TRUE(own.ends_with("{ long x; }; }; };"));
}

TEST(McapClouds, LivoxPointsOfRos2LieTwentyBytesApart) {
  const auto type = known_ros2_type("livox_ros_driver2/CustomMsg");
  ASSERT_TRUE(type);
  const auto decoder = MessageDecoder::create(type->name, type->definition, type->format);
  ASSERT_TRUE(decoder) << decoder.error().message;
  MessageBytes bytes(Serialization::kCdr);
  bytes.time(3 * kSecond);
  bytes.text("livox");
  bytes.put(std::uint64_t{2'900'000'000});  // timebase
  bytes.put(std::uint32_t{3});
  for (int i = 0; i < 4; ++i) bytes.put(std::uint8_t{0});
  bytes.length(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    bytes.put(1000 * i);
    for (const float offset : {0.0F, 0.25F, 0.5F}) bytes.put(static_cast<float>(i) + offset);
    for (const std::uint32_t value : {200, 16, 5}) {
      bytes.put(static_cast<std::uint8_t>(value + i));
    }
  }
  const auto view = decoder->decode(bytes.view());
  ASSERT_TRUE(view) << view.error().message;
  const auto cloud = point_table(*view);
  ASSERT_TRUE(cloud) << cloud.error().message;
  ASSERT_EQ(cloud->size(), 3U);
  EXPECT_EQ(cloud->stamp, 3 * kSecond);
  EXPECT_EQ(cloud->time_base, 2'900'000'000);
  EXPECT_EQ(cloud->bytes.data() + cloud->bytes.size(), bytes.view().data() + bytes.view().size());
  const auto value = [&](const char* field, std::size_t point) {
    return PointField(*cloud, *cloud->find(field)).at(cloud->point(point));
  };
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(value("offset_time", i), 1000.0 * static_cast<double>(i));
    EXPECT_EQ(value("z", i), static_cast<double>(i) + 0.5);
    EXPECT_EQ(value("line", i), 5.0 + static_cast<double>(i));
  }
}

TEST_F(Mcap, ConvertingABagKeepsValuesTimesAndOrder) {
  const std::vector<SampleMessage> written = {{"/a", 3, std::string("\2\0\0\0hi", 6)},
                                              {"/b", 4, std::string("\0\0\0\0", 4)}};
  write_bag(path("r.bag"), written);
  auto source = BagReader::open(path("r.bag"));
  auto sink = McapWriter::create(path());
  ASSERT_TRUE(source && sink);
  const auto outcome = convert_messages(*source, *sink, [](Time) { return true; });
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->messages, 2U);
  EXPECT_EQ(outcome->topics, 2U);
  const ReadOutcome read = read_all<McapReader>(path());
  EXPECT_EQ(read.messages,
            (std::vector<SampleMessage>{{"/a", 3, std::string("\0\1\0\0\3\0\0\0hi\0", 11)},
                                        {"/b", 4, std::string("\0\1\0\0\1\0\0\0\0", 9)}}));
  // Back to ROS 1 there is no way.
  auto again = McapReader::open(path());
  auto bag = BagWriter::create(path("back.bag"));
  ASSERT_TRUE(again && bag);
  const auto refused = convert_messages(*again, *bag, [](Time) { return true; });
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("topic '/a': messages of ROS 2"), std::string::npos);
}

}  // namespace
}  // namespace aims
