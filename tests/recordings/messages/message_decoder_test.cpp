// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_decoder.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
// rapidcheck's gtest glue needs both headers above it.
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "core/files/byte_cursor.hpp"
#include "recordings/messages/message_definition.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/recordings/messages/random_message.hpp"

namespace aims {
namespace {

constexpr const char* kSeparator =
    "================================================================================\n";

MessageDecoder decoder_of(const MessageType& type) {
  auto decoder = MessageDecoder::create(type.name, type.definition);
  EXPECT_TRUE(decoder) << decoder.error().message;
  return *decoder;
}

std::string creation_error(const std::string& definition, const std::string& type = "p/T") {
  const auto decoder = MessageDecoder::create(type, definition);
  return decoder ? "" : decoder.error().message;
}

MessageFormat format_of(ByteStyle style) {
  return style == ByteStyle::kRos1 ? kRos1Format : kRos2Format;
}

void expect_every_value(const RandomMessage& message, const std::string& definition,
                        MessageFormat format) {
  const auto decoder = MessageDecoder::create(message.type(), definition, format);
  RC_ASSERT(decoder.has_value());
  const auto view = decoder->decode(bytes_of(message.bytes()));
  RC_ASSERT(view.has_value());
  for (const auto& [path, value] : message.numbers) RC_ASSERT(view->number(path) == value);
  for (const auto& [path, value] : message.arrays) RC_ASSERT(view->numbers(path) == value);
  for (const auto& [path, value] : message.times) RC_ASSERT(view->time(path) == value);
  for (const auto& [path, value] : message.texts) RC_ASSERT(view->text(path) == value);
  for (const auto& [path, value] : message.sizes) RC_ASSERT(view->size(path) == value);
}

RC_GTEST_PROP(MessageDecoder, ReadsEveryValueOfAnyMessage, ()) {
  for (const ByteStyle style : {ByteStyle::kRos1, ByteStyle::kCdrLittle, ByteStyle::kCdrBig}) {
    const RandomMessage message(*rc::gen::inRange<std::uint32_t>(0, 1'000'000), style);
    expect_every_value(message, message.definition(), format_of(style));
    if (style == ByteStyle::kRos1) continue;
    expect_every_value(message, message.idl(), {Serialization::kCdr, DefinitionLanguage::kRos2Idl});
  }
}

RC_GTEST_PROP(MessageDecoder, EntriesAndTablesAgreeWithPaths, ()) {
  for (const ByteStyle style : {ByteStyle::kRos1, ByteStyle::kCdrLittle, ByteStyle::kCdrBig}) {
    const RandomMessage message(*rc::gen::inRange<std::uint32_t>(0, 1'000'000), style);
    const auto decoder =
        MessageDecoder::create(message.type(), message.definition(), format_of(style));
    const auto view = decoder->decode(bytes_of(message.bytes()));
    RC_ASSERT(view.has_value());
    for (const auto& [path, value] : message.numbers) {
      const std::size_t close = path.find("].");
      if (close == std::string::npos) continue;
      const std::size_t open = path.find('[');
      const std::string array = path.substr(0, open);
      const std::size_t entry = std::stoul(path.substr(open + 1));
      const std::string rest = path.substr(close + 2);
      RC_ASSERT(view->messages(array)->at(entry).number(rest) == value);
      const auto table = view->table(array);
      const ColumnLayout* column = table ? table->find(rest) : nullptr;
      if (column == nullptr) continue;
      const std::byte* row = table->bytes.data() + entry * table->stride;
      RC_ASSERT(row + column->offset + size_of(column->type) <=
                table->bytes.data() + table->bytes.size());
      RC_ASSERT(number_at(row + column->offset, column->type, table->order) == value);
    }
  }
}

RC_GTEST_PROP(MessageDecoder, RejectsTruncatedAndOverlongMessages, ()) {
  for (const ByteStyle style : {ByteStyle::kRos1, ByteStyle::kCdrLittle}) {
    const RandomMessage message(*rc::gen::inRange<std::uint32_t>(0, 1'000'000), style);
    const auto decoder =
        MessageDecoder::create(message.type(), message.definition(), format_of(style));
    RC_ASSERT(decoder.has_value());
    for (std::size_t size = 0; size < message.bytes().size(); ++size) {
      RC_ASSERT(!decoder->decode(bytes_of(message.bytes()).first(size)));
    }
    const std::string padding(style == ByteStyle::kRos1 ? 0 : 3, 'x');
    RC_ASSERT(decoder->decode(bytes_of(message.bytes() + padding)).has_value());
    RC_ASSERT(!decoder->decode(bytes_of(message.bytes() + padding + "x")));
  }
}

TEST(MessageDecoder, PathsOfOtherKindsYieldNothing) {
  const MessageDecoder decoder = decoder_of(transforms_type());
  const MessageBytes bytes = transforms_message(kSecond, {{"a", "b", Pose{}}, {"a", "c", Pose{}}});
  const auto view = decoder.decode(bytes.view());
  ASSERT_TRUE(view) << view.error().message;
  EXPECT_EQ(view->text("transforms[1].child_frame_id"), "c");
  EXPECT_EQ(view->number("transforms[1].transform.rotation.w"), 1.0);
  EXPECT_EQ(view->size("transforms"), 2U);
  for (const char* path :
       {"", ".", "transforms[2].child_frame_id", "transforms[1]", "transforms", "transforms[1].",
        "transforms[-1].child_frame_id", "transforms[1]child_frame_id", "transforms[", "[0]",
        "transforms[99999999999].child_frame_id", "transforms[1].header", "child_frame_id"}) {
    EXPECT_FALSE(view->text(path)) << path;
    EXPECT_FALSE(view->number(path)) << path;
    EXPECT_FALSE(view->time(path)) << path;
    EXPECT_FALSE(view->bytes(path)) << path;
    EXPECT_FALSE(view->numbers(path)) << path;
    EXPECT_FALSE(view->texts(path)) << path;
  }
  EXPECT_FALSE(view->number("transforms[1].child_frame_id"));
  EXPECT_FALSE(view->text("transforms[1].transform.rotation.w"));
  EXPECT_FALSE(view->table("transforms")) << "rows of no fixed size";
}

TEST(MessageDecoder, EntriesOfAnArrayAreMessages) {
  const MessageBytes bytes = transforms_message(
      kSecond, {{"a", "b", Pose{}}, {"a", "longer", {Eigen::Quaterniond::Identity(), {1, 2, 3}}}});
  const auto view = decoder_of(transforms_type()).decode(bytes.view());
  ASSERT_TRUE(view) << view.error().message;
  const auto entries = view->messages("transforms");
  ASSERT_TRUE(entries);
  ASSERT_EQ(entries->size(), 2U);
  EXPECT_EQ((*entries)[0].text("child_frame_id"), "b");
  EXPECT_EQ((*entries)[1].text("child_frame_id"), "longer");
  EXPECT_EQ((*entries)[1].time("header.stamp"), kSecond);
  EXPECT_EQ((*entries)[1].number("transform.translation.z"), 3.0);
  EXPECT_FALSE((*entries)[1].text("transforms[0].child_frame_id"));
  EXPECT_FALSE(view->messages("transforms[0]"));
  EXPECT_FALSE(view->messages("nothing"));
}

TEST(MessageDecoder, ACloudsDataIsNotCopied) {
  const MessageDecoder decoder = decoder_of(point_cloud_type());
  LidarScan scan;
  scan.points.resize(100);
  const MessageBytes bytes = cloud_message({0, kSecond, "lidar"}, scan);
  const auto view = decoder.decode(bytes.view());
  ASSERT_TRUE(view) << view.error().message;
  const auto data = view->bytes("data");
  ASSERT_TRUE(data);
  EXPECT_EQ(data->size(), 2200U);
  EXPECT_GE(data->data(), bytes.view().data());
  EXPECT_LE(data->data() + data->size(), bytes.view().data() + bytes.view().size());
  EXPECT_EQ(view->text("fields[4].name"), "ring");
  EXPECT_EQ(view->number("is_dense"), 1.0);
  EXPECT_EQ(view->time("header.stamp"), kSecond);
}

TEST(MessageDecoder, ArraysOfFixedMessagesAreTables) {
  const std::string definition = std::string("Point[] points\nuint8 after\n") + kSeparator +
                                 "MSG: livox/Point\nuint32 offset_time\nfloat32 x\nbool hit\n" +
                                 "time t\nV v\nint16[2] pair\n" + kSeparator +
                                 "MSG: livox/V\nfloat64 z\n";
  const auto decoder = MessageDecoder::create("livox/Custom", definition);
  ASSERT_TRUE(decoder) << decoder.error().message;
  std::vector<std::byte> bytes;
  append_number(bytes, std::uint32_t{2});
  for (std::uint32_t i = 0; i < 2; ++i) {
    append_number(bytes, 100 + i);
    append_number(bytes, 1.5F);
    append_number(bytes, std::uint8_t{1});
    append_number(bytes, std::uint32_t{7});
    append_number(bytes, std::uint32_t{8});
    append_number(bytes, 2.5);
    append_number(bytes, std::int16_t{-3});
    append_number(bytes, std::int16_t{-4});
  }
  append_number(bytes, std::uint8_t{9});
  const auto view = decoder->decode(bytes);
  ASSERT_TRUE(view) << view.error().message;
  const auto table = view->table("points");
  ASSERT_TRUE(table);
  EXPECT_EQ(table->rows, 2U);
  EXPECT_EQ(table->stride, 29U);
  EXPECT_EQ(table->bytes.size(), 58U);
  const auto value = [&](std::string_view name, std::size_t row) {
    const ColumnLayout* column = table->find(name);
    EXPECT_NE(column, nullptr) << name;
    return number_at(table->bytes.data() + row * table->stride + column->offset, column->type);
  };
  EXPECT_EQ(value("offset_time", 1), 101.0);
  EXPECT_EQ(value("t.sec", 1), 7.0);
  EXPECT_EQ(value("t.nsec", 0), 8.0);
  EXPECT_EQ(value("v.z", 1), 2.5);
  EXPECT_EQ(value("pair", 1), -3.0);
  EXPECT_EQ(table->find("pair")->count, 2U);
  EXPECT_EQ(table->find("nothing"), nullptr);
  EXPECT_EQ(view->number("after"), 9.0);
}

TEST(MessageDecoder, FieldsAreListedInOrder) {
  const std::string definition = std::string("Header header\nfloat32[4] force\nbool ok\n") +
                                 kSeparator +
                                 "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
  const auto decoder = MessageDecoder::create("p/Contacts", definition);
  ASSERT_TRUE(decoder) << decoder.error().message;
  std::vector<std::string> paths;
  for (const MessageField& field : decoder->fields()) paths.push_back(field.path);
  EXPECT_EQ(paths, (std::vector<std::string>{"header.seq", "header.stamp", "header.frame_id",
                                             "force", "ok"}));
  EXPECT_EQ(decoder->fields()[3].kind, FieldKind::kNumbers);
  EXPECT_EQ(decoder->fields()[3].number, NumberType::kFloat32);
  EXPECT_TRUE(decoder->fields()[4].is_bool);
}

TEST(MessageDecoder, ABareNamePrefersTheUsersPackage) {
  const std::string definition = std::string("V a\nother/V b\n") + kSeparator +
                                 "MSG: other/V\nfloat64 x\n" + kSeparator + "MSG: p/V\nuint8 x\n";
  const auto decoder = MessageDecoder::create("p/T", definition);
  ASSERT_TRUE(decoder) << decoder.error().message;
  EXPECT_EQ(decoder->fields()[0].number, NumberType::kUint8);
  EXPECT_EQ(decoder->fields()[1].number, NumberType::kFloat64);
}

TEST(MessageDecoder, ErrorsOfDefinitionsNameTheLine) {
  EXPECT_EQ(creation_error("uint8 a\nV b\n"),
            "definition of 'p/T': line 2: unknown message definition 'V' of field 'b'");
  EXPECT_EQ(creation_error("uint8 a\nuint8\n"),
            "definition of 'p/T', line 2: expected 'TYPE NAME', found 'uint8'");
  EXPECT_NE(creation_error("uint8[-1] a\n").find("line 1: expected 'TYPE NAME'"),
            std::string::npos);
  EXPECT_NE(creation_error("uint8[0] a\n"), "");
  EXPECT_NE(creation_error("uint8[<=3] a\n"), "");
  EXPECT_NE(creation_error("uint8 a\nuint8 a\n").find("names a field twice"), std::string::npos);
  EXPECT_NE(creation_error("uint8 a\n", "no type").find("expected a type's name"),
            std::string::npos);
  EXPECT_NE(creation_error("float64[4000000000] a\n").find("field 'a' makes the message larger"),
            std::string::npos);
  const std::string itself = std::string("V v\n") + kSeparator + "MSG: p/V\nV[] v\n";
  EXPECT_NE(creation_error(itself).find("type 'p/V' holds itself"), std::string::npos);
  const std::string empty = std::string("V[] v\n") + kSeparator + "MSG: p/V\n";
  EXPECT_NE(creation_error(empty).find("an array of empty messages"), std::string::npos);
  EXPECT_EQ(creation_error("", "std_msgs/Empty"), "");
}

TEST(MessageDecoder, TheTextOfRos2HasBoundsDefaultsAndConstants) {
  const std::string definition =
      "# a comment\nuint8 KIND=3 # three\nstring<=8 NAME=\"a # b\"\nwstring WIDE='x'\n"
      "std_msgs/Header header\nint32[<=4] few\nstring<=8[] words\nstring greeting \"a=b # c\"\n"
      "float64 scale 1.5 # with a default\nint8[3] signs [-1, 0, 1]\nother_msgs/msg/V v\n" +
      std::string(kSeparator) +
      "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + kSeparator +
      "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" + kSeparator +
      "MSG: other_msgs/msg/V\nbuiltin_interfaces/Duration d\n";
  const auto types = parse_definition("p/msg/T", definition, DefinitionLanguage::kRos2Msg);
  ASSERT_TRUE(types) << types.error().message;
  ASSERT_EQ(types->front().constants.size(), 3U);
  EXPECT_EQ(types->front().constants[0].value, "3");
  EXPECT_EQ(types->front().constants[1].value, "\"a # b\"");
  EXPECT_EQ(types->front().name, "p/T");
  const auto decoder = MessageDecoder::create("p/msg/T", definition, kRos2Format);
  ASSERT_TRUE(decoder) << decoder.error().message;
  std::vector<std::string> paths;
  for (const MessageField& field : decoder->fields()) paths.push_back(field.path);
  EXPECT_EQ(paths, (std::vector<std::string>{"header.stamp", "header.frame_id", "few", "words",
                                             "greeting", "scale", "signs", "v.d"}));
}

TEST(MessageDecoder, WideTextIsRefusedWhereItWouldBeRead) {
  const auto refused = MessageDecoder::create("p/T", "int8 a\nwstring<=4 b\n", kRos2Format);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("line 2: field 'b' is a wstring"), std::string::npos)
      << refused.error().message;
}

TEST(MessageDecoder, AnEmptyTypeTakesOneByteInCdr) {
  const auto decoder = MessageDecoder::create("std_msgs/Empty", "# nothing\n", kRos2Format);
  ASSERT_TRUE(decoder) << decoder.error().message;
  EXPECT_TRUE(decoder->decode(bytes_of(std::string("\0\1\0\0\0", 5))));
  EXPECT_FALSE(decoder->decode(bytes_of(std::string("\0\1\0\0", 4))));
}

TEST(MessageDecoder, OtherEncapsulationsAreRefused) {
  const auto decoder = MessageDecoder::create("std_msgs/Bool", "bool data\n", kRos2Format);
  const auto message = [&](const std::string& bytes) {
    const auto view = decoder->decode(bytes_of(bytes));
    return view ? "" : view.error().message;
  };
  EXPECT_EQ(message(std::string("\0\1\0\0\1", 5)), "");
  EXPECT_EQ(message(std::string("\0\3\0\0\1", 5)),
            "std_msgs/Bool: expected a header of plain CDR (00 00 or 00 01), found 00 03");
  EXPECT_EQ(message("x"), "std_msgs/Bool: expected the 4 bytes of a CDR header, found 1");
  EXPECT_EQ(message(std::string("\0\1\0\0", 4)),
            "std_msgs/Bool: field 'data' needs 1 bytes at byte 4, but the message ends at byte 4");
}

TEST(MessageDecoder, ExpandingDefinitionsAreRejected) {
  std::string deep = "T1 a\n";
  std::string wide = "W1 a\nW1 b\n";
  for (int i = 1; i < 30; ++i) {
    const std::string self = std::to_string(i);
    const std::string next = std::to_string(i + 1);
    deep += kSeparator + ("MSG: p/T" + self + "\nT" + next + " a\n");
    wide += kSeparator + ("MSG: p/W" + self + "\nW" + next + " a\nW" + next + " b\n");
  }
  deep += kSeparator + std::string("MSG: p/T30\nuint8 a\n");
  EXPECT_NE(creation_error(deep).find("nested deeper than 16"), std::string::npos);
  wide.resize(wide.find("MSG: p/W13"));
  wide += "MSG: p/W13\nuint8 a\n";
  EXPECT_NE(creation_error(wide).find("more than 4096 fields"), std::string::npos);
}

TEST(MessageDecoder, ErrorsOfTruncatedMessagesNameTheField) {
  const MessageDecoder decoder = decoder_of(transforms_type());
  const MessageBytes bytes = transforms_message(kSecond, {{"a", "b", Pose{}}, {"a", "c", Pose{}}});
  const std::size_t size = bytes.view().size();
  EXPECT_EQ(
      decoder.decode(bytes.view().first(size - 3)).error().message,
      "tf2_msgs/TFMessage: field 'transforms[1].transform.rotation.w' needs 8 bytes at byte " +
          std::to_string(size - 8) + ", but the message ends at byte " + std::to_string(size - 3));
  std::vector<std::byte> longer(bytes.view().begin(), bytes.view().end());
  longer.resize(size + 5);
  EXPECT_EQ(decoder.decode(longer).error().message, "tf2_msgs/TFMessage: expected a message of " +
                                                        std::to_string(size) + " bytes, found " +
                                                        std::to_string(size + 5));
  const std::uint32_t many = 0xffffffff;
  std::memcpy(longer.data(), &many, 4);
  EXPECT_NE(decoder.decode(longer).error().message.find("field 'transforms[2]."),
            std::string::npos);
}

}  // namespace
}  // namespace aims
