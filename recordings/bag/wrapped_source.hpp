// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "recordings/bag/message_source.hpp"

namespace aims {

/// A source that passes on another one, of which it changes connections, summary or messages.
class WrappedSource : public MessageSource {
 public:
  std::string name() const override { return source_.name(); }
  const std::vector<BagConnection>& connections() const override { return connections_; }
  const BagSummary& summary() const override { return summary_ ? *summary_ : source_.summary(); }
  void select(std::span<const std::string> topics) override { source_.select(topics); }
  void rewind() override { source_.rewind(); }

 protected:
  explicit WrappedSource(std::unique_ptr<MessageSource> source)
      : owned_(std::move(source)), source_(*owned_), connections_(source_.connections()) {}
  /// `source` must outlive it.
  explicit WrappedSource(MessageSource& source)
      : source_(source), connections_(source_.connections()) {}

  /// The next message of the source, as one of the own connections.
  Result<std::optional<BagMessage>> read() {
    auto message = source_.next();
    if (summary_) summary_->repeated_messages = source_.summary().repeated_messages;
    if (message && *message) (*message)->connection = connection((*message)->connection->id);
    return message;
  }

  const BagConnection* connection(std::uint32_t id) const {
    return &*std::ranges::find(connections_, id, &BagConnection::id);
  }

 private:
  std::unique_ptr<MessageSource> owned_;

 protected:
  MessageSource& source_;
  std::vector<BagConnection> connections_;
  std::optional<BagSummary> summary_;  ///< where it is not that of the source
};

}  // namespace aims
