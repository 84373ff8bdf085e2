// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_reader.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
// rapidcheck's gtest glue needs both headers above it.
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "tests/recordings/bag/bag_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

std::vector<SampleMessage> in_order_of_time(std::vector<SampleMessage> messages) {
  std::stable_sort(messages.begin(), messages.end(),
                   [](const SampleMessage& a, const SampleMessage& b) { return a.time < b.time; });
  return messages;
}

RC_GTEST_PROP(BagReader, ReturnsMessagesInOrderOfTimeThenPosition, ()) {
  const TemporaryFolder folder;
  std::vector<SampleMessage> messages;
  const int count = *rc::gen::inRange(0, 60);
  for (int i = 0; i < count; ++i) {
    // Few distinct times: ties and chunks that overlap are the rule.
    messages.push_back({*rc::gen::element<std::string>("/a", "/b", "/c"),
                        kSecond + *rc::gen::inRange(0, 20), *rc::gen::arbitrary<std::string>()});
  }
  BagWriterOptions options;
  options.compression =
      *rc::gen::element(BagCompression::kNone, BagCompression::kLz4, BagCompression::kBz2);
  options.chunk_size = *rc::gen::element<std::size_t>(1, 200, 1000, 1 << 20);
  const auto file = folder.path() / "r.bag";
  write_bag(file, messages, options);
  const ReadOutcome read = read_all(file);
  RC_ASSERT(read.error == "");
  RC_ASSERT(read.messages == in_order_of_time(messages));
  RC_ASSERT(read.summary.messages == messages.size());
  const ReadOutcome recovered = read_all(file, {.recover = true});
  RC_ASSERT(recovered.messages == read.messages);
  RC_ASSERT(recovered.summary.lost_bytes == 0U);
}

TEST(BagReader, SummaryCoversTheWholeBag) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.bag";
  write_bag(file, few_messages(), {BagCompression::kLz4, 300});
  const auto bag = BagReader::open(file);
  ASSERT_TRUE(bag) << bag.error().message;
  const BagSummary& summary = bag->summary();
  EXPECT_EQ(summary.file_size, std::filesystem::file_size(file));
  EXPECT_EQ(summary.messages, 12U);
  EXPECT_GT(summary.chunks, 2U);
  EXPECT_EQ(summary.start, kSecond);
  EXPECT_EQ(summary.end, kSecond + 110 * kMillisecond);
  EXPECT_EQ(summary.compression, "lz4");
  EXPECT_TRUE(summary.indexed);
  ASSERT_EQ(bag->connections().size(), 2U);
  EXPECT_EQ(bag->connections()[0].topic, "/b");
  EXPECT_EQ(bag->connections()[0].messages, 4U);
  EXPECT_EQ(bag->connections()[1].messages, 8U);
  EXPECT_EQ(bag->connections()[0].type, "std_msgs/String");
  EXPECT_EQ(bag->connections()[0].definition, string_type().definition);
  EXPECT_EQ(bag->connections()[0].md5, string_type().md5);
}

TEST(BagReader, SelectRestrictsTopicsFromTheCurrentPosition) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.bag";
  write_bag(file, few_messages(), {BagCompression::kNone, 150});
  auto bag = BagReader::open(file);
  ASSERT_TRUE(bag);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(bag->next().value());
  const std::vector<std::string> topics = {"/b", "/not there"};
  bag->select(topics);
  std::vector<Time> times;
  for (auto message = bag->next().value(); message; message = bag->next().value()) {
    EXPECT_EQ(message->connection->topic, "/b");
    times.push_back(message->record_time);
  }
  EXPECT_EQ(times, (std::vector<Time>{kSecond + 60 * kMillisecond, kSecond + 90 * kMillisecond}));
  bag->rewind();
  EXPECT_EQ(bag->next().value()->record_time, kSecond);
  const std::vector<std::string> both = {"/a", "/b"};
  bag->select(both);
  EXPECT_EQ(bag->next().value()->record_time, kSecond + 10 * kMillisecond);
}

TEST(BagReader, ChunksWithoutTheTopicsAreNotRead) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.bag";
  std::vector<SampleMessage> messages = few_messages();
  messages.insert(messages.begin(), {"/damaged", kSecond, "xyzxyz"});
  write_bag(file, messages, {BagCompression::kNone, 1});
  std::string bytes = read_file(file).value();
  patch(bytes, "conn=", 1, std::uint32_t{99});
  ASSERT_TRUE(put_file(file, bytes));
  EXPECT_NE(read_all(file).error, "");
  auto bag = BagReader::open(file);
  ASSERT_TRUE(bag);
  const std::vector<std::string> topics = {"/b"};
  bag->select(topics);
  int count = 0;
  for (auto message = bag->next(); message && *message; message = bag->next()) ++count;
  EXPECT_EQ(count, 4);
}

TEST(BagReader, ChunksThatOverlapInTimeBeyondTheLimitAreAnError) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.bag";
  std::vector<SampleMessage> messages;
  for (int i = 0; i < 10; ++i) {
    messages.push_back({"/a", kSecond + i, std::string(1000, 'x')});
    messages.push_back({"/a", 2 * kSecond + i, std::string(1000, 'x')});
  }
  write_bag(file, messages, {BagCompression::kNone, 1500});
  const ReadOutcome enough = read_all(file, {.memory_limit = 40'000});
  EXPECT_EQ(enough.error, "");
  EXPECT_EQ(enough.messages, in_order_of_time(messages));
  const ReadOutcome scarce = read_all(file, {.memory_limit = 10'000});
  EXPECT_NE(scarce.error.find("chunks overlap in time and need more than 10000 bytes"),
            std::string::npos)
      << scarce.error;
}

TEST(BagReader, RecoversTheIntactChunksOfEveryTruncatedBag) {
  const TemporaryFolder folder;
  const auto whole = folder.path() / "whole.bag";
  const auto file = folder.path() / "cut.bag";
  const std::vector<SampleMessage> messages = few_messages();
  write_bag(whole, messages, {BagCompression::kLz4, 250});
  const std::string bytes = read_file(whole).value();
  std::size_t most = 0;
  for (std::size_t size = 4117; size < bytes.size(); size += 7) {
    ASSERT_TRUE(put_file(file, bytes.substr(0, size)));
    const ReadOutcome refused = read_all(file);
    EXPECT_NE(refused.error.find("ends at byte " + std::to_string(size)), std::string::npos)
        << refused.error;
    const ReadOutcome recovered = read_all(file, {.recover = true});
    EXPECT_EQ(recovered.error, "");
    const char* const advice =
        recovered.messages.empty() ? "; no chunk of it is intact" : "; --recover reads";
    EXPECT_NE(refused.error.find(advice), std::string::npos) << refused.error;
    EXPECT_FALSE(recovered.summary.indexed);
    EXPECT_EQ(refused.kind == ErrorKind::kRecoverable, !recovered.messages.empty());
    EXPECT_GE(recovered.messages.size(), most);
    most = recovered.messages.size();
    EXPECT_TRUE(std::equal(recovered.messages.begin(), recovered.messages.end(), messages.begin()));
  }
  EXPECT_EQ(most, messages.size());
}

TEST(BagReader, RecoverySkipsAndCountsADamagedChunk) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.bag";
  const std::vector<SampleMessage> messages = few_messages();
  write_bag(file, messages, {BagCompression::kBz2, 250});
  std::string bytes = read_file(file).value();
  const std::size_t second = bytes.find("BZh9", bytes.find("BZh9") + 1);
  bytes[second + 30] = static_cast<char>(bytes[second + 30] ^ 0x10);
  ASSERT_TRUE(put_file(file, bytes));
  const ReadOutcome refused = read_all(file);
  EXPECT_NE(refused.error.find("bz2"), std::string::npos) << refused.error;
  const ReadOutcome recovered = read_all(file, {.recover = true});
  EXPECT_EQ(recovered.error, "");
  EXPECT_GT(recovered.messages.size(), 6U);
  EXPECT_LT(recovered.messages.size(), messages.size());
  EXPECT_GT(recovered.summary.lost_bytes, 0U);
}

}  // namespace
}  // namespace aims
