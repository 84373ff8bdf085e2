// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_publisher.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "recordings/bag/bag_records.hpp"

namespace aims {
namespace {

/// Where the file header has its numbers, each behind a length and a name.
constexpr std::size_t kChunkCount = 13 + 4 + (4 + 12);
constexpr std::size_t kIndexPosition = kChunkCount + 4 + (4 + 11 + 4) + (4 + 10);

/// Keeps the file as it is, and after every step holds it against what was promised: the index that
/// the header points at is one that was given, and all the chunks of which it tells are there.
class CheckedOutput final : public BagOutput {
 public:
  CheckedOutput() : image_(as_text(BagPublisher::empty_bag())) {}

  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
    if (image_.size() < offset + bytes.size()) image_.resize(offset + bytes.size(), '?');
    // Byte by byte, as a kill may cut it; the header's few bytes come all at once.
    const bool whole = offset < kFileHeaderSize;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      image_[offset + i] = static_cast<char>(bytes[i]);
      if (!whole) check();
    }
    check();
    return {};
  }
  Result<void> truncate(std::uint64_t size) override {
    image_.resize(size);
    check();
    return {};
  }
  Result<void> close() override { return {}; }

  /// A chunk to come, and the index that will tell of it.
  void add(const std::string& chunk, const std::string& index) {
    chunks_ += chunk;
    indices_.push_back(index);
    chunk_ends_.push_back(chunks_.size());
  }
  std::size_t closed() const { return closed_; }
  const std::string& image() const { return image_; }

 private:
  void check() {
    const auto position = load_number<std::uint64_t>(bytes_of(image_).data() + kIndexPosition);
    const auto count = load_number<std::uint32_t>(bytes_of(image_).data() + kChunkCount);
    ASSERT_GE(count, closed_) << "what was closed stays";
    closed_ = count;
    if (count == 0) return;
    const std::string& index = indices_[count - 1];
    ASSERT_EQ(image_.substr(position, index.size()), index);
    const std::size_t size = chunk_ends_[count - 1];
    ASSERT_EQ(image_.substr(BagPublisher::empty_bag().size(), size), chunks_.substr(0, size));
  }

  std::string image_;
  std::string chunks_;
  std::vector<std::string> indices_;
  std::vector<std::size_t> chunk_ends_;
  std::size_t closed_ = 0;
};

TEST(BagPublisher, NeverOverwritesTheCurrentIndex) {
  std::mt19937 random(5);
  for (int run = 0; run < 3000; ++run) {
    auto owned = std::make_unique<CheckedOutput>();
    CheckedOutput& output = *owned;
    BagPublisher publisher(std::move(owned), random() % 12);
    BagIndexBytes index;
    std::size_t size = 0;
    std::string text;
    for (char name = 'a'; name < 'i'; ++name) {
      const std::string chunk(1 + random() % 9, name);
      text += std::string(1 + random() % 4, static_cast<char>(name - 'a' + 'A'));
      index.chunk_infos.assign(bytes_of(text).begin(), bytes_of(text).end());
      ++index.chunk_count;
      size += chunk.size();
      output.add(chunk, text);
      ASSERT_TRUE(publisher.add_chunk(bytes_of(chunk), index));
      ASSERT_EQ(output.closed(), index.chunk_count);
    }
    ASSERT_TRUE(publisher.finish(index));
    EXPECT_EQ(output.image().size(), BagPublisher::empty_bag().size() + size + text.size());
    if (HasFatalFailure()) FAIL() << "run " << run;
  }
}

}  // namespace
}  // namespace aims
