// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/chunk.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

struct BagOpenOptions {
  /// Read the intact chunks of a recording that was never closed or was truncated, instead of an
  /// error.
  bool recover = false;
  /// Chunks in memory at a time; a recording that needs more is an error [bytes].
  std::size_t memory_limit = std::size_t{1} << 30;
  /// Further files or folders of the same recording, merged in order of record time.
  std::vector<std::filesystem::path> with = {};
  /// Put files of recorders whose clocks differ on one clock, by the stamps of their messages.
  bool one_clock = false;
  /// Leave out what a live estimate heard before that of which it decided.
  bool as_live = false;
};

/// A file whose messages lie in chunks.
class ChunkContainer {
 public:
  virtual ~ChunkContainer() = default;
  virtual const BagFile& file() const = 0;
  /// In the order of the file; none is empty. A chunk without counts may hold any connection.
  virtual const std::vector<ChunkPlace>& chunks() const = 0;
  /// Unpacks a chunk, finds its messages and compares them with the index.
  virtual Result<void> load(const ChunkPlace& place, ChunkContent& content) = 0;
  /// What makes chunks small, or sorted by time: completes the error of too much memory.
  virtual std::string_view remedy() const = 0;
};

/// Reads a file of chunks message by message in order of record time, then of place in the file.
/// Memory is bounded by the chunks that overlap in time. Errors name the file, the offset and what
/// was expected.
class ChunkReader : public MessageSource {
 public:
  ~ChunkReader() override;

  const std::filesystem::path& file() const;
  std::string name() const override { return file().string(); }
  /// In order of their ids.
  const std::vector<BagConnection>& connections() const override;
  const BagSummary& summary() const override;

  /// Restricts `next` to these topics; chunks without them are not read. Absent topics are ignored.
  void select(std::span<const std::string> topics) override;

  /// The next message, or nothing at the end.
  Result<std::optional<BagMessage>> next() override;

  /// Starts again at the first message.
  void rewind() override;

 protected:
  /// `connections` in order of their ids.
  ChunkReader(std::unique_ptr<ChunkContainer> container, std::vector<BagConnection> connections,
              BagSummary summary, std::size_t memory_limit);
  ChunkReader(ChunkReader&&) noexcept;
  ChunkReader& operator=(ChunkReader&&) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Totals from the chunks; message counts are theirs.
BagSummary summarize(const BagFile& file, std::span<const ChunkPlace> chunks);

}  // namespace aims
