// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/bag/bag_reader.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "recordings/bag/bag_index.hpp"

namespace aims {
namespace {

class BagContainer final : public ChunkContainer {
 public:
  BagContainer(BagFile file, BagIndex index, bool recover)
      : file_(std::move(file)), index_(std::move(index)), recover_(recover) {}

  const BagFile& file() const override { return file_; }
  const std::vector<ChunkPlace>& chunks() const override { return index_.chunks; }

  Result<void> load(const ChunkPlace& place, ChunkContent& content) override {
    Result<void> got = load_chunk(file_, place, index_.connections, content);
    if (got && !recover_) got = check_chunk_index(file_, place, content);
    if (got || recover_) return got;
    return failure(got.error().message + "; --recover skips damaged chunks",
                   ErrorKind::kRecoverable);
  }

  std::string_view remedy() const override {
    return "a copy made by `rosbag filter` has smaller chunks, sorted by time";
  }

 private:
  BagFile file_;
  BagIndex index_;
  bool recover_;
};

}  // namespace

Result<BagReader> BagReader::open(const std::filesystem::path& path, BagOpenOptions options) {
  auto file = BagFile::open(path);
  if (!file) return tl::unexpected(file.error());
  auto index = options.recover ? recover_index(*file, options.memory_limit)
                               : read_index(*file, options.memory_limit);
  if (!index) return tl::unexpected(index.error());
  BagSummary summary = summarize(*file, index->chunks);
  summary.indexed = summary.closed = index->indexed;
  summary.lost_bytes = index->lost_bytes;
  std::vector<BagConnection> connections;
  for (const auto& [id, connection] : index->connections.all()) connections.push_back(connection);
  auto container =
      std::make_unique<BagContainer>(std::move(*file), std::move(*index), options.recover);
  return BagReader(std::move(container), std::move(connections), std::move(summary),
                   options.memory_limit);
}

}  // namespace aims
