// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "recordings/bag/message_source.hpp"

namespace aims {

/// Several sources as one, in order of record time; of equal times the source added first goes
/// first. A message that two sources hold (topic, record time and bytes) is given and counted once.
/// A topic of one type is one connection. Memory is that of the sources whose times overlap.
class MergedSource final : public MessageSource {
 public:
  explicit MergedSource(std::string name) : name_(std::move(name)) {}

  /// Before the first call of `next`; `shift` is added to its record times.
  void add(std::unique_ptr<MessageSource> source, Duration shift = 0);
  /// Counts bytes of a file that could not be opened.
  void lose(std::uint64_t bytes) { summary_.lost_bytes += bytes; }
  void set_compression(std::string name) { summary_.compression = std::move(name); }
  bool empty() const { return parts_.empty(); }

  std::string name() const override { return name_; }
  const std::vector<BagConnection>& connections() const override { return connections_; }
  /// A chunk is a source.
  const BagSummary& summary() const override { return summary_; }
  void select(std::span<const std::string> topics) override;
  Result<std::optional<BagMessage>> next() override;
  void rewind() override;

 private:
  struct Part {
    std::unique_ptr<MessageSource> source;
    Duration shift = 0;                 ///< of its record times
    std::vector<std::uint32_t> places;  ///< of its connections, by their ids, in the whole
    std::optional<BagMessage> waiting;  ///< its next message
    bool ended = false;
  };
  using Key = std::tuple<std::string, std::string, std::string, Serialization, bool>;

  void join_connections(Part& part);
  void add_summary(const BagSummary& part, Duration shift);
  /// Fetches the next message of each part that may be the next of all; returns the earliest.
  Result<std::optional<std::size_t>> earliest();
  void drop_copies(std::size_t first);

  std::string name_;
  std::vector<Part> parts_;
  std::map<Key, std::uint32_t> places_;
  std::vector<BagConnection> connections_;
  std::set<std::string> compressions_;
  BagSummary summary_;
  std::optional<std::size_t> lent_;  ///< the part whose message the caller has
};

}  // namespace aims
