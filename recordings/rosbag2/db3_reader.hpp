// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "recordings/bag/chunk_reader.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// Reads one SQLite file of rosbag2, of any version of its schema. Messages come in order of record
/// time, then of their rows; their list is in memory, at most `memory_limit` bytes. SQLite has no
/// checksums: `recover` opens a file only if its structure is intact. Errors name the file.
class Db3Reader final : public MessageSource {
 public:
  static Result<Db3Reader> open(const std::filesystem::path& file, BagOpenOptions options = {});
  Db3Reader(Db3Reader&&) noexcept;
  Db3Reader& operator=(Db3Reader&&) noexcept;
  ~Db3Reader() override;

  std::string name() const override;
  const std::vector<BagConnection>& connections() const override;
  const BagSummary& summary() const override;
  void select(std::span<const std::string> topics) override;
  /// The offset of a message is the number of its row.
  Result<std::optional<BagMessage>> next() override;
  void rewind() override;

 private:
  struct Impl;
  explicit Db3Reader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
