// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

/// Messages that are made of the data of another format: of a few kinds, each with a topic. A chunk
/// is the entire file.
class KindSource : public MessageSource {
 public:
  /// Of the kinds that have messages.
  const std::vector<BagConnection>& connections() const override { return connections_; }
  const BagSummary& summary() const override { return summary_; }
  void select(std::span<const std::string> topics) override;
  Result<std::optional<BagMessage>> next() override;

 protected:
  struct Kind {
    std::string topic;
    MessageType type;
    bool latching = false;
  };

  /// A message, valid until the next one is made.
  struct Made {
    std::size_t kind = 0;
    Time record_time = 0;
    std::span<const std::byte> data;
    std::uint64_t offset = 0;
  };

  KindSource(std::span<const Kind> kinds, std::uint64_t file_size);

  /// The next message of any kind, or nothing at the end.
  virtual Result<std::optional<Made>> make() = 0;

  /// Makes all messages once, for their numbers and times, and rewinds.
  Result<void> count();

  /// Marks the summary: the file was not read to its end; `lost`: what is behind [bytes].
  void set_incomplete(std::uint64_t lost) {
    summary_.indexed = summary_.closed = false;
    summary_.lost_bytes = lost;
  }

  void set_untimed(std::uint64_t rows) { summary_.untimed_rows = rows; }
  void set_lost_packets(double fraction) { summary_.lost_packets = fraction; }

 private:
  std::vector<BagConnection> connections_;
  std::vector<bool> chosen_;
  BagSummary summary_;
};

}  // namespace aims
