// SPDX-License-Identifier: BSD-3-Clause
// Files that are no bag, no longer a bag, or lie: each is refused with its own words.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "recordings/bag/bag_records.hpp"
#include "tests/recordings/bag/bag_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// A bag made of few messages, for a test to change its bytes.
class HostileBag : public testing::Test {
 protected:
  std::string sample(BagCompression compression = BagCompression::kNone,
                     std::size_t chunk_size = 300) {
    fs::remove(file_);
    write_bag(file_, few_messages(), {compression, chunk_size});
    return read_file(file_).value();
  }

  /// What reading those bytes says; always begins with the file's name.
  std::string error_of(const std::string& bytes, BagOpenOptions options = {}) {
    EXPECT_TRUE(put_file(file_, bytes));
    const std::string error = read_all(file_, options).error;
    EXPECT_TRUE(error.empty() || error.starts_with(file_.string() + ": ")) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
  }

  void expect_error(const std::string& bytes, const std::string& part) {
    const std::string error = error_of(bytes);
    EXPECT_NE(error.find(part), std::string::npos) << "found: " << error;
  }

  TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "hostile.bag";
};

TEST_F(HostileBag, PathsThatAreNotFilesAreErrors) {
  EXPECT_NE(read_all(folder_.path() / "none.bag").error.find("No such file"), std::string::npos);
  EXPECT_NE(read_all(folder_.path()).error.find("it is a directory"), std::string::npos);
  EXPECT_NE(read_all("/dev/zero").error.find("expected a regular file"), std::string::npos);
}

TEST_F(HostileBag, FilesThatAreNotBagsAreErrors) {
  expect_error("", "at byte 0: expected a ROS 1 bag, found an empty file");
  expect_error("stamp x y z\n1 2 3 4\n", "('#ROSBAG V2.0'), found 'stamp x y z\\x0a1'");
  expect_error("#ROSBAG V1.2\nabc", "expected a bag of version 2.0, found '#ROSBAG V1.2'");
  expect_error("\x89MCAP0\r\nabcdefghijk", "an MCAP file");
  expect_error(std::string("SQLite format 3\0", 16), "perhaps a ROS 2 bag");
  expect_error("#ROSBAG V2.0\n", "at byte 13: expected a record, but the file ends at byte 13");
}

TEST_F(HostileBag, NeverClosed) {
  std::string bytes = sample();
  patch(bytes, "index_pos=", 0, std::uint64_t{0});
  expect_error(bytes,
               "at byte 13: the bag was never closed and has no index; --recover reads the intact "
               "chunks, `rosbag reindex` repairs it");
  EXPECT_EQ(error_of(bytes, {.recover = true}), "");
}

TEST_F(HostileBag, Encrypted) {
  const std::string bytes = sample();
  std::vector<std::byte> header;
  HeaderBuilder(header)
      .number("chunk_count", std::uint32_t{0})
      .number("conn_count", std::uint32_t{0})
      .text("encryptor", "rosbag/AesCbcEncryptor")
      .number("index_pos", std::uint64_t{4117})
      .op(BagOp::kFileHeader)
      .finish();
  append_data(header, {});
  expect_error(bytes.substr(0, 13) + std::string(as_text(header)),
               "encrypted by rosbag/AesCbcEncryptor");
}

TEST_F(HostileBag, AnIndexBeyondTheEnd) {
  std::string bytes = sample();
  patch(bytes, "index_pos=", 0, std::uint64_t{1} << 63);
  expect_error(bytes, "at byte 9223372036854775808: expected the index, but the file ends at");
  patch(bytes, "index_pos=", 0, std::uint64_t{4117});
  expect_error(bytes, "at byte 4117: expected a connection in the index, found a chunk");
}

TEST_F(HostileBag, MoreConnectionsOrChunksThanThereAre) {
  std::string bytes = sample();
  patch(bytes, "conn_count=", 0, std::uint32_t{0xffffffff});
  expect_error(bytes, "expected a connection in the index, found a chunk's info");
  bytes = sample();
  patch(bytes, "chunk_count=", 0, std::uint32_t{0xffffffff});
  expect_error(bytes, "expected a record, but the file ends at byte");
}

TEST_F(HostileBag, AHeaderLongerThanTheFile) {
  std::string bytes = sample();
  const std::uint32_t huge = 0xfffffff0;
  std::memcpy(bytes.data() + 13, &huge, 4);
  expect_error(bytes, "expected a record's header of at most 65536 bytes, found 4294967280");
  bytes = sample();
  std::memcpy(bytes.data() + 17, &huge, 4);
  expect_error(bytes, "expected a field 'name=value' at byte 0 of a header of");
}

TEST_F(HostileBag, ChunksOfAWrongSize) {
  std::string bytes = sample();
  patch(bytes, "size=", 0, std::uint32_t{1000000});
  expect_error(bytes, "at byte 4117: a chunk of 1000000 bytes cannot be packed into");
  bytes = sample(BagCompression::kLz4);
  patch(bytes, "size=", 0, std::uint32_t{4000000000});
  expect_error(bytes, "at byte 4117: a chunk of 4000000000 bytes cannot be packed into");
  for (const BagCompression compression : {BagCompression::kLz4, BagCompression::kBz2}) {
    bytes = sample(compression);
    patch(bytes, "size=", 0, std::uint32_t{20});
    expect_error(bytes, "at byte 4117: in this chunk: expected 20 bytes when unpacked, found more");
    patch(bytes, "size=", 0, std::uint32_t{5000});
    expect_error(bytes, "at byte 4117: in this chunk: expected 5000 bytes when unpacked, found ");
  }
  patch(bytes, "size=", 0, std::uint32_t{4000000000});
  expect_error(bytes, " bytes of memory, more than 1073741824");
  patch(bytes, "size=", 0, std::uint32_t{1000000000});
  expect_error(bytes, "expected 1000000000 bytes when unpacked, found ");
}

TEST_F(HostileBag, DamagedPackedBytes) {
  std::string bytes = sample(BagCompression::kLz4);
  bytes[4117 + 100] = static_cast<char>(bytes[4117 + 100] ^ 0xff);
  expect_error(bytes, "at byte 4117: in this chunk: lz4: ");
  bytes = sample(BagCompression::kBz2);
  bytes[4117 + 100] = static_cast<char>(bytes[4117 + 100] ^ 0xff);
  expect_error(bytes, "at byte 4117: in this chunk: bz2: damaged");
}

TEST_F(HostileBag, UnknownCompression) {
  std::string bytes = sample();
  bytes.replace(bytes.find("compression=none"), 16, "compression=zstd");
  expect_error(bytes, "at byte 4117: expected compression none, lz4 or bz2, found 'zstd'");
}

TEST_F(HostileBag, AMessageOfAnUnknownConnection) {
  std::string bytes = sample();
  // Field 0 is the connection record's in the first chunk, field 1 that of its first message.
  patch(bytes, "conn=", 1, std::uint32_t{77});
  expect_error(bytes, "a message of connection 77, which no record announces");
  EXPECT_NE(error_of(bytes).find("at byte 4117: in this chunk, at byte "), std::string::npos);
}

TEST_F(HostileBag, ContradictingConnectionRecords) {
  std::string bytes = sample();
  bytes.replace(bytes.find("topic=/b"), 8, "topic=/c");
  expect_error(bytes,
               "connection 0 is '/c' of std_msgs/String, but was announced as '/b' of "
               "std_msgs/String");
}

TEST_F(HostileBag, AMessageLongerThanItsChunk) {
  std::string bytes = sample();
  const std::size_t message = bytes.find("message 0");
  const std::uint32_t size = 100000;
  std::memcpy(bytes.data() + message - 4, &size, 4);
  expect_error(bytes, "expected 100000 bytes of a message, found ");
}

TEST_F(HostileBag, AnIndexThatContradictsItsChunk) {
  std::string bytes = sample();
  const std::size_t entry = bytes.find("ver=", 4117) + 12;
  for (const std::size_t at : {entry, entry + 5, entry + 8}) {
    bytes = sample();
    bytes[at] = static_cast<char>(bytes[at] + 1);
    expect_error(bytes, "of the chunk, which is not there");
  }
  bytes = sample();
  const std::size_t infos = bytes.find("chunk_pos=");
  patch(bytes, "start_time=", 0, std::uint64_t{3});
  expect_error(bytes, "expected a record time from 3000000000 to");
  bytes = sample();
  const std::size_t counts = bytes.find("ver=", infos) + 12;
  bytes[counts + 4] = static_cast<char>(bytes[counts + 4] + 1);
  expect_error(bytes, "of connection 0 in this chunk, as the index states, found");
  bytes = sample();
  bytes[counts] = 9;
  expect_error(bytes, "a chunk's info names connection 9 which no record announces");
}

TEST_F(HostileBag, AChunkListedTwice) {
  std::string bytes = sample();
  patch(bytes, "chunk_pos=", 1, std::uint64_t{4117});
  expect_error(bytes, "at byte 4117: the index has a chunk here, inside the one at byte 4117");
  patch(bytes, "chunk_pos=", 1, std::uint64_t{13});
  expect_error(bytes, "at byte 13: expected a chunk, found the file header");
}

TEST_F(HostileBag, AnyChangedByteIsReadOrAnError) {
  std::mt19937 random(7);
  for (const BagCompression compression :
       {BagCompression::kNone, BagCompression::kLz4, BagCompression::kBz2}) {
    const std::string whole = sample(compression);
    for (int i = 0; i < 400; ++i) {
      std::string bytes = whole;
      // Padding is of no interest.
      const std::size_t at =
          i % 8 == 0 ? 13 + random() % 80 : 4117 + random() % (bytes.size() - 4117);
      bytes[at] = static_cast<char>(random());
      static_cast<void>(error_of(bytes));
      const ReadOutcome recovered = read_all(file_, {.recover = true});
      EXPECT_LE(recovered.messages.size(), 12U);
    }
  }
}

}  // namespace
}  // namespace aims
