// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

struct BagOpenOptions {
  /// Read the intact chunks of a bag that was never closed or was truncated, instead of an error.
  bool recover = false;
  /// Chunks in memory at a time; a bag that needs more is an error [bytes].
  std::size_t memory_limit = std::size_t{1} << 30;
};

/// Reads a ROS 1 bag (format 2.0) message by message in order of record time, then of place in the
/// file. Memory is bounded by the chunks that overlap in time: each length in the file is checked
/// before it is used. Errors name the file, the offset and what was expected.
class BagReader final : public MessageSource {
 public:
  static Result<BagReader> open(const std::filesystem::path& file, BagOpenOptions options = {});
  BagReader(BagReader&&) noexcept;
  BagReader& operator=(BagReader&&) noexcept;
  ~BagReader() override;

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

 private:
  struct Impl;
  explicit BagReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
