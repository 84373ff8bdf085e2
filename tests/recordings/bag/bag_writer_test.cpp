// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_writer.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <random>

#include "recordings/bag/bag_output.hpp"
#include "recordings/bag/bag_publisher.hpp"
#include "tests/recordings/bag/bag_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// What was done to a file, step by step.
struct Operation {
  bool truncate = false;
  std::uint64_t offset = 0;  ///< or the new size
  std::string bytes;
};

class RecordedOutput final : public BagOutput {
 public:
  explicit RecordedOutput(std::vector<Operation>& operations) : operations_(operations) {}
  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    operations_.push_back({false, offset, std::string(as_text(bytes))});
    return {};
  }
  Result<void> truncate(std::uint64_t size) override {
    operations_.push_back({true, size, {}});
    return {};
  }
  Result<void> close() override { return {}; }

 private:
  std::vector<Operation>& operations_;
};

void apply(const Operation& operation, std::size_t part, std::string& image) {
  if (operation.truncate) {
    image.resize(operation.offset);
    return;
  }
  if (image.size() < operation.offset + part) image.resize(operation.offset + part);
  image.replace(operation.offset, part, operation.bytes, 0, part);
}

/// The image opens and holds the first messages, at least `least` of them.
void expect_whole(const fs::path& file, const std::string& image,
                  const std::vector<SampleMessage>& messages, std::size_t least) {
  ASSERT_TRUE(put_file(file, image));
  const ReadOutcome read = read_all(file);
  ASSERT_EQ(read.error, "");
  ASSERT_GE(read.messages.size(), least);
  ASSERT_LE(read.messages.size(), messages.size());
  ASSERT_TRUE(std::equal(read.messages.begin(), read.messages.end(), messages.begin()));
}

/// Replays a bag's writing, cut off after each step and in the middle of each.
void check_every_prefix(std::uint32_t seed, BagWriterOptions options) {
  SCOPED_TRACE(seed);
  const TemporaryFolder folder;
  std::mt19937 random(seed);
  std::vector<Operation> operations;
  std::vector<std::size_t> closed_before;  ///< messages in closed chunks when a step began
  std::vector<SampleMessage> messages;
  auto bag = BagWriter::create(std::make_unique<RecordedOutput>(operations), "r.bag", options);
  ASSERT_TRUE(bag);
  std::size_t closed = 0;
  for (int i = 0; i < 30; ++i) {
    // A new topic now and then makes the index grow.
    if (i % 7 == 0) bag->add_connection("/topic" + std::to_string(i / 7), string_type());
    const std::size_t size = random() % 5 == 0 ? random() % 12000 : random() % 100;
    messages.push_back({"/topic" + std::to_string(i / 7), kSecond + i, std::string(size, 'x')});
    ASSERT_TRUE(bag->write(static_cast<std::uint32_t>(i / 7), messages.back().time,
                           bytes_of(messages.back().bytes)));
    const bool chunk_closed = closed_before.size() < operations.size();
    closed_before.resize(operations.size(), closed);
    if (chunk_closed) closed = messages.size();
  }
  ASSERT_TRUE(bag->close());
  closed_before.resize(operations.size(), closed);
  std::string image(as_text(BagPublisher::empty_bag()));
  const auto file = folder.path() / "r.bag";
  for (std::size_t i = 0; i < operations.size(); ++i) {
    expect_whole(file, image, messages, closed_before[i]);
    const Operation& operation = operations[i];
    const bool is_header = !operation.truncate && operation.offset < 4096;
    if (!is_header && !operation.truncate) {
      std::string torn = image;
      apply(operation, random() % (operation.bytes.size() + 1), torn);
      expect_whole(file, torn, messages, closed_before[i]);
    }
    // The header's few bytes lie within one page: a kill leaves all of them or none.
    if (is_header) {
      EXPECT_LT(operation.offset + operation.bytes.size(), 4096U);
    }
    apply(operation, operation.bytes.size(), image);
  }
  expect_whole(file, image, messages, messages.size());
}

TEST(BagWriter, LeavesAValidBagAfterEveryStep) {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    const std::size_t chunk = seed % 3 == 0 ? 1 : (seed % 3 == 1 ? 300 : 2000);
    check_every_prefix(seed, {seed % 2 == 0 ? BagCompression::kNone : BagCompression::kLz4, chunk});
  }
}

TEST(BagWriter, AClosedBagHasNoGaps) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.bag";
  write_bag(file, few_messages(), {BagCompression::kNone, 100});
  const std::string bytes = read_file(file).value();
  // Record follows record from the first byte to the last.
  std::size_t at = 13;
  int records = 0;
  while (at < bytes.size()) {
    for (int part = 0; part < 2; ++part) {
      std::uint32_t size = 0;
      ASSERT_LE(at + 4, bytes.size());
      std::memcpy(&size, bytes.data() + at, 4);
      at += 4 + size;
    }
    ++records;
  }
  EXPECT_EQ(at, bytes.size());
  EXPECT_GT(records, 20);
}

TEST(BagWriter, ABagWithoutMessagesListsItsTopics) {
  const TemporaryFolder folder;
  auto bag = BagWriter::create(folder.path() / "r.bag");
  ASSERT_TRUE(bag);
  EXPECT_EQ(read_all(folder.path() / "r.bag").error, "");
  bag->add_connection("/silent", string_type(), true);
  ASSERT_TRUE(bag->close());
  const auto read = BagReader::open(folder.path() / "r.bag");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->connections().size(), 1U);
  EXPECT_TRUE(read->connections()[0].latching);
}

TEST(BagWriter, TheDestructorCloses) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.bag";
  {
    auto bag = BagWriter::create(file);
    bag->add_connection("/a", string_type());
    ASSERT_TRUE(bag->write(0, kSecond, bytes_of("abc")));
    BagWriter moved = std::move(*bag);
  }
  EXPECT_EQ(read_all(file).messages.size(), 1U);
}

TEST(BagWriter, RefusesAnExistingFileAndAMissingFolder) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.bag";
  ASSERT_TRUE(put_file(file, "precious"));
  const auto existing = BagWriter::create(file);
  ASSERT_FALSE(existing);
  EXPECT_EQ(existing.error().message, file.string() + ": cannot be created: File exists");
  EXPECT_EQ(read_file(file).value(), "precious");
  const auto missing = BagWriter::create(folder.path() / "no" / "r.bag");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("No such file"), std::string::npos);
}

TEST(BagWriter, RejectsWhatABagCannotStore) {
  const TemporaryFolder folder;
  auto bag = BagWriter::create(folder.path() / "r.bag");
  bag->add_connection("/a", string_type());
  EXPECT_NE(bag->write(0, 0, {}).error().message.find("above 0"), std::string::npos);
  EXPECT_NE(bag->write(0, -5, {}).error().message.find("found -5 ns"), std::string::npos);
  EXPECT_NE(bag->write(0, (Time{1} << 32) * kSecond, {}).error().message.find("2^32"),
            std::string::npos);
  EXPECT_NE(bag->write(1, 5, {}).error().message.find("no connection 1"), std::string::npos);
  ASSERT_TRUE(bag->close());
  EXPECT_NE(bag->write(0, 5, {}).error().message.find("closed"), std::string::npos);
  EXPECT_TRUE(bag->close());
}

/// Limits the size of files for its lifetime; what goes beyond fails as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

TEST(BagWriter, AFullDiskIsAnErrorAndKeepsTheClosedChunks) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "r.bag";
  std::string error;
  int written = 0;
  {
    const FileSizeLimit limit(300'000);
    auto bag = BagWriter::create(file, {BagCompression::kNone, 20'000});
    ASSERT_TRUE(bag);
    bag->add_connection("/a", string_type());
    for (; written < 1000; ++written) {
      const auto outcome = bag->write(0, kSecond + written, bytes_of(std::string(2000, 'x')));
      if (outcome) continue;
      error = outcome.error().message;
      break;
    }
    EXPECT_EQ(bag->close().error().message, error);
  }
  EXPECT_EQ(error, file.string() + ": cannot be written: File too large");
  const ReadOutcome read = read_all(file);
  EXPECT_EQ(read.error, "");
  EXPECT_GT(read.messages.size(), 50U);
  EXPECT_GE(read.messages.size() + 12, static_cast<std::size_t>(written));
}

}  // namespace
}  // namespace aims
