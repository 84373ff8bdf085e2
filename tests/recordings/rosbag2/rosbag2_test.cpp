// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "core/files/sqlite_database.hpp"
#include "core/files/yaml_scalars.hpp"
#include "recordings/messages/ros2_definition.hpp"
#include "recordings/rosbag2/rosbag2_metadata.hpp"
#include "recordings/rosbag2/rosbag2_reader.hpp"
#include "recordings/rosbag2/rosbag2_writer.hpp"
#include "recordings/source/recording_file.hpp"
#include "tests/recordings/bag/bag_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTables =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
    "INSERT INTO topics VALUES (7, '/a', 'std_msgs/msg/String', 'cdr');"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data "
    "BLOB);";

class Rosbag2 : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }

  ReadOutcome read(const fs::path& recording, BagOpenOptions options = {}) const {
    return read_all<Rosbag2Reader>(recording, options);
  }

  /// What is read of a file that these statements make.
  ReadOutcome read_database(const std::string& sql, BagOpenOptions options = {}) const {
    fs::remove(path("r.db3"));
    EXPECT_TRUE(SqliteDatabase::create(path("r.db3")).value().run(sql));
    return read(path("r.db3"), options);
  }

  void expect_error(const std::string& sql, const std::string& expected,
                    BagOpenOptions options = {}) const {
    const std::string error = read_database(sql, options).error;
    EXPECT_NE(error.find(expected), std::string::npos) << error;
    EXPECT_TRUE(error.starts_with(path("r.db3").string() + ": ")) << error;
  }

  TemporaryFolder folder_;
};

TEST_F(Rosbag2, KeepsEveryMessageInOrderOfTime) {
  std::vector<SampleMessage> messages = few_messages();
  std::swap(messages[3], messages[9]);
  messages[5].bytes.clear();
  write_bag<Rosbag2Writer>(path("walk.partial"), messages, {.chunk_size = 100});
  std::ranges::stable_sort(messages, {}, &SampleMessage::time);
  for (const char* name : {"walk.partial", "walk.partial/walk_0.db3"}) {
    for (const bool recover : {false, true}) {
      const ReadOutcome outcome = read(path(name), {.recover = recover});
      EXPECT_EQ(outcome.error, "");
      EXPECT_EQ(outcome.messages, messages);
      EXPECT_EQ(outcome.summary.messages, messages.size());
      EXPECT_EQ(outcome.summary.start, messages.front().time);
      EXPECT_EQ(outcome.summary.end, messages.back().time);
    }
  }
}

TEST_F(Rosbag2, TheSameMessagesGiveTheSameBytes) {
  write_bag<Rosbag2Writer>(path("a"), few_messages());
  write_bag<Rosbag2Writer>(path("b"), few_messages());
  EXPECT_EQ(read_file(path("a/a_0.db3")).value(), read_file(path("b/b_0.db3")).value());
}

TEST_F(Rosbag2, FilesOfASplitRecordingAreMergedByTime) {
  const std::vector<SampleMessage> all = few_messages();
  std::vector<SampleMessage> first(all.begin(), all.begin() + 7),
      second(all.begin() + 7, all.end());
  std::swap(first[6], second[0]);
  write_bag<Rosbag2Writer>(path("r"), first);
  write_bag<Rosbag2Writer>(path("s"), second);
  fs::rename(path("s/s_0.db3"), path("r/r_1.db3"));
  ASSERT_TRUE(put_file(path("r/metadata.yaml"),
                       "rosbag2_bagfile_information:\n"
                       "  relative_file_paths: [r_0.db3, foxy_folder/r_1.db3]\n"));
  const ReadOutcome outcome = read(path("r"));
  EXPECT_EQ(outcome.error, "");
  EXPECT_EQ(outcome.messages, all);
  EXPECT_EQ(outcome.summary.chunks, 2U);
  EXPECT_EQ(Rosbag2Reader::open(path("r"))->connections().size(), 2U);
}

TEST_F(Rosbag2, ConnectionsHaveTypeCountAndLatching) {
  auto writer = Rosbag2Writer::create(path("r")).value();
  const auto imu = ros2_type(imu_type()).value();
  const auto a = writer.add_connection("/a", imu, false);
  const auto b = writer.add_connection("/b", imu, true);
  ASSERT_TRUE(writer.write(b, 7, bytes_of("1")));
  ASSERT_TRUE(writer.write(a, 8, bytes_of("2")));
  EXPECT_FALSE(writer.write(9, 9, bytes_of("")));
  EXPECT_FALSE(writer.write(a, -1, bytes_of("")));
  ASSERT_TRUE(writer.close());
  EXPECT_FALSE(writer.write(a, 10, bytes_of("")));
  EXPECT_FALSE(Rosbag2Writer::create(path("r")));
  auto reader = Rosbag2Reader::open(path("r")).value();
  ASSERT_EQ(reader.connections().size(), 2U);
  EXPECT_EQ(reader.connections()[0].type, "sensor_msgs/Imu");
  EXPECT_EQ(reader.connections()[0].definition, imu.definition);
  EXPECT_EQ(reader.connections()[0].format, kRos2Format);
  EXPECT_EQ(reader.connections()[1].messages, 1U);
  EXPECT_FALSE(reader.connections()[0].latching);
  EXPECT_TRUE(reader.connections()[1].latching);
  for (int again = 0; again < 2; ++again) {
    reader.select(std::vector<std::string>{"/a"});
    reader.rewind();
    EXPECT_EQ(as_text((**reader.next()).data), "2");
    EXPECT_FALSE(*reader.next());
  }
}

TEST_F(Rosbag2, UsualTypesWithoutDefinitionsHaveTheBuiltInOnes) {
  for (const char* type :
       {"sensor_msgs/PointCloud2", "sensor_msgs/Imu", "sensor_msgs/JointState", "nav_msgs/Odometry",
        "geometry_msgs/PoseStamped", "tf2_msgs/TFMessage", "livox_ros_driver2/CustomMsg"}) {
    fs::remove(path("r.db3"));
    auto database = SqliteDatabase::create(path("r.db3")).value();
    ASSERT_TRUE(database.run(kTables));
    ASSERT_TRUE(database.run("UPDATE topics SET type = '" +
                             std::string(type).insert(std::string(type).find('/'), "/msg") + "'"));
    const auto reader = Rosbag2Reader::open(path("r.db3"));
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(reader->connections()[0].type, type);
    EXPECT_EQ(reader->connections()[0].definition, known_ros2_type(type)->definition);
  }
}

TEST_F(Rosbag2, DatabasesOfOthersAreRefusedByName) {
  expect_error("CREATE TABLE t(x)", "expected a recording of rosbag2, with the tables");
  const std::string tables = kTables;
  expect_error(tables + "INSERT INTO messages VALUES (1, 8, 5, x'00')",
               "message 1: of topic 8, which the file does not list");
  expect_error(tables + "INSERT INTO messages VALUES (1, 7, -5, x'00')",
               "message 1: expected a time >= 0 in ns, found -5");
  expect_error(tables + "INSERT INTO messages VALUES (1, 7, 'noon', x'00')", "found noon");
  ASSERT_TRUE(put_file(path("text.db3"), std::string(5000, 'x')));
  auto opened = open_recording(path("text.db3"));
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("expected a file of rosbag2"), std::string::npos);
}

TEST_F(Rosbag2, WhatASchemaComputesIsNotRun) {
  const std::string topics = std::string(kTables) + "DROP TABLE messages;";
  expect_error(topics +
                   "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL "
                   "SELECT id + 1 FROM n) SELECT id, 7 AS topic_id, id AS timestamp, "
                   "zeroblob(1000000000) AS data FROM n",
               "expected a recording of rosbag2");
  const auto outcome = read_database(
      topics +
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
      "data AS (zeroblob(900000000)));"
      "INSERT INTO messages(topic_id, timestamp) VALUES (7, 1)");
  EXPECT_NE(outcome.error.find("string or blob too big (message 1)"), std::string::npos)
      << outcome.error;
}

TEST_F(Rosbag2, MemoryIsBounded) {
  const std::string rows = std::string(kTables) +
                           "WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM n WHERE "
                           "id < 5000) INSERT INTO messages SELECT id, 7, id, zeroblob(9) FROM n;";
  EXPECT_EQ(read_database(rows).messages.size(), 5000U);
  expect_error(rows, "the list of messages needs more than 100000 bytes",
               {.memory_limit = 100'000});
  const std::string blob =
      std::string(kTables) + "INSERT INTO messages VALUES (1, 7, 1, zeroblob(300000));";
  EXPECT_EQ(read_database(blob).messages.size(), 1U);
  expect_error(blob, "too big", {.memory_limit = 100'000});
  // A frame of zstd that states 1 GB.
  expect_error(std::string(kTables) +
                   "INSERT INTO messages VALUES (1, 7, 1, x'28b52ffd' || x'a0' || x'0000004000');",
               "this message needs 1073741824 bytes of memory, more than 1000000",
               {.memory_limit = 1'000'000});
}

/// Whatever bytes a file has, reading ends, with the right messages or an error.
TEST_F(Rosbag2, DamagedPagesEndInAnErrorOrInMessages) {
  write_bag<Rosbag2Writer>(path("r"), few_messages());
  const std::string whole = read_file(path("r/r_0.db3")).value();
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += 97) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x55);
    ASSERT_TRUE(put_file(path("damaged.db3"), bytes));
    const ReadOutcome outcome = read(path("damaged.db3"), {.memory_limit = 1 << 20});
    EXPECT_LE(outcome.messages.size(), 12U);
    refused += outcome.error.empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 0);
}

TEST_F(Rosbag2, AFileThatIsListedTwiceIsReadOnceAndNoneOutsideTheFolder) {
  write_bag<Rosbag2Writer>(path("walk"), few_messages());
  const auto once = read(path("walk"));
  const auto list = [&](const std::string& files) {
    EXPECT_TRUE(write_file_atomically(
        path("walk/metadata.yaml"),
        "rosbag2_bagfile_information:\n  relative_file_paths: [" + files + "]\n"));
    return read(path("walk"));
  };
  EXPECT_EQ(list("walk_0.db3, ./walk_0.db3, walk_0.db3").messages.size(), once.messages.size());
  fs::create_symlink("walk_0.db3", path("walk/soft.db3"));
  fs::create_hard_link(path("walk/walk_0.db3"), path("walk/hard.db3"));
  EXPECT_EQ(list("soft.db3, hard.db3, walk_0.db3").messages.size(), once.messages.size());
  fs::copy(path("walk/walk_0.db3"), path("other.db3"));
  EXPECT_NE(list("../other.db3").error.find("expected the file '../other.db3'"), std::string::npos);
}

TEST_F(Rosbag2, RecoveryDoesWithoutMetadataThatAreEmpty) {
  write_bag<Rosbag2Writer>(path("walk"), few_messages());
  const auto whole = read(path("walk"));
  EXPECT_TRUE(write_file_atomically(path("walk/metadata.yaml"), std::string_view()));
  EXPECT_NE(read(path("walk")).error, "");
  EXPECT_EQ(read(path("walk"), {.recover = true}).messages.size(), whole.messages.size());
}

TEST_F(Rosbag2, AFolderIsARecordingByItsMetadata) {
  EXPECT_EQ(format_by_content(folder_.path()), std::nullopt);
  const auto empty = open_recording(folder_.path());
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.error().message.find("it is a directory, expected a recording"),
            std::string::npos);
  write_bag<Rosbag2Writer>(path("r"), few_messages());
  EXPECT_EQ(format_by_content(path("r")), RecordingFormat::kRosbag2);
  fs::remove(path("r/metadata.yaml"));
  const ReadOutcome refused = read(path("r"));
  EXPECT_NE(refused.error.find("was never completed; --recover reads"), std::string::npos);
  EXPECT_EQ(refused.kind, ErrorKind::kRecoverable);
  EXPECT_EQ(read(path("r"), {.recover = true}).messages, few_messages());
  fs::resize_file(path("r/r_0.db3"), 512);
  const ReadOutcome lost = read(path("r"));
  EXPECT_NE(lost.error.find("was never completed; none of its files can be read"),
            std::string::npos)
      << lost.error;
  EXPECT_EQ(lost.kind, ErrorKind::kOther);
}

TEST_F(Rosbag2, EncryptedAndPackedFilesAreNamedAsSuch) {
  for (const auto& [start, words] :
       {std::pair("Salted__abcdefgh", "the file is encrypted: decrypt it first"),
        {"age-encryption.org/v1\n-> X25519", "the file is encrypted"},
        {"\x28\xb5\x2f\xfd packed", "unpack it with unzstd"},
        {"7z\xbc\xaf\x27\x1c", "unpack it with 7z x"}}) {
    std::ofstream(path("x.bag"), std::ios::binary) << start;
    const auto refused = open_recording(path("x.bag"));
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find(words), std::string::npos) << refused.error().message;
    EXPECT_EQ(refused.error().message.find("--recover"), std::string::npos);
  }
}

TEST(YamlScalars, AreNamedByTheirPlaceAndBounded) {
  const auto scalars = yaml_scalars("a: {b: [x, {c: 'y: z'}]}\nd: 3\ne: []\n", "f.yaml").value();
  EXPECT_EQ(scalars,
            (std::map<std::string, std::string>{{"a.b.0", "x"}, {"a.b.1.c", "y: z"}, {"d", "3"}}));
  std::string bomb = "a: &a [x, x, x, x, x, x, x, x, x, x]\n";
  for (char c = 'b'; c < 'm'; ++c) {
    const std::string last = "*" + std::string(1, static_cast<char>(c - 1));
    bomb += std::string(1, c) + ": &" + c + " [" + last;
    for (int i = 0; i < 9; ++i) bomb += ", " + last;
    bomb += "]\n";
  }
  const auto refused = yaml_scalars(bomb, "f.yaml");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "f.yaml: expected at most 200000 values");
}

}  // namespace
}  // namespace aims
