// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/mcap/mcap_reader.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>
#include <vector>

#include "recordings/mcap/mcap_index.hpp"

namespace aims {
namespace {

class McapContainer final : public ChunkContainer {
 public:
  McapContainer(BagFile file, McapIndex index, bool recover)
      : file_(std::move(file)), index_(std::move(index)), recover_(recover) {}

  const BagFile& file() const override { return file_; }
  const std::vector<ChunkPlace>& chunks() const override { return index_.chunks; }

  Result<void> load(const ChunkPlace& place, ChunkContent& content) override {
    std::uint64_t lost = 0;
    Result<void> got =
        load_mcap_chunk(file_, place, index_.definitions, content, recover_ ? &lost : nullptr);
    if (got && !recover_) got = check_content(place, content);
    if (got || recover_) return got;
    return failure(got.error().message + "; --recover skips damaged chunks",
                   ErrorKind::kRecoverable);
  }

  std::string_view remedy() const override {
    return "a copy made by `mcap sort` has smaller chunks, sorted by time";
  }

 private:
  /// Error when the chunk holds a time or a channel that its index excludes.
  Result<void> check_content(const ChunkPlace& place, const ChunkContent& content) const {
    for (const ChunkMessage& message : content.messages) {
      if (message.time < place.start || message.time > place.end) {
        return refuse_in_chunk(
            file_, place, message.offset,
            fmt::format("expected a log time from {} to {} ns, as the chunk states, found {}",
                        place.start, place.end, message.time));
      }
      if (!place.counts.empty() && !place.counts.contains(message.connection)) {
        return refuse_in_chunk(
            file_, place, message.offset,
            fmt::format("a message of channel {}, which the index omits", message.connection));
      }
    }
    return {};
  }

  BagFile file_;
  McapIndex index_;
  bool recover_;
};

}  // namespace

Result<McapReader> McapReader::open(const std::filesystem::path& path, BagOpenOptions options) {
  auto file = BagFile::open(path);
  if (!file) return tl::unexpected(file.error());
  auto index = options.recover ? recover_mcap_index(*file, options.memory_limit)
                               : read_mcap_index(*file, options.memory_limit);
  if (!index) return tl::unexpected(index.error());
  BagSummary summary = summarize(*file, index->chunks);
  summary.messages = index->messages;
  summary.indexed = index->indexed;
  summary.lost_bytes = index->lost_bytes;
  summary.closed = index->closed;
  summary.lost_messages = index->lost_messages;
  std::vector<BagConnection> connections = index->definitions.connections();
  for (BagConnection& each : connections) {
    const auto count = index->counts.find(each.id);
    if (count != index->counts.end()) each.messages = count->second;
  }
  auto container =
      std::make_unique<McapContainer>(std::move(*file), std::move(*index), options.recover);
  return McapReader(std::move(container), std::move(connections), std::move(summary),
                    options.memory_limit);
}

}  // namespace aims
