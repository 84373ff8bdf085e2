// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "recordings/bag/chunk_reader.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// Reads a recording of rosbag2: a folder whose metadata.yaml lists SQLite or MCAP files, or a
/// single SQLite file. The files are merged in order of record time. Files that are compressed by
/// zstd are unpacked to the folder for temporary files, messages one by one.
class Rosbag2Reader final : public MessageSource {
 public:
  /// `recover` reads the intact files of a folder, and one without metadata.yaml.
  static Result<Rosbag2Reader> open(const std::filesystem::path& recording,
                                    BagOpenOptions options = {});
  Rosbag2Reader(Rosbag2Reader&&) noexcept;
  Rosbag2Reader& operator=(Rosbag2Reader&&) noexcept;
  ~Rosbag2Reader() override;

  std::string name() const override;
  const std::vector<BagConnection>& connections() const override;
  /// A chunk is a file.
  const BagSummary& summary() const override;
  void select(std::span<const std::string> topics) override;
  Result<std::optional<BagMessage>> next() override;
  void rewind() override;

 private:
  struct Impl;
  explicit Rosbag2Reader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
