// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "recordings/bag/message_source.hpp"
#include "ros/ros_message.hpp"

namespace aims {

/// Messages that have come and wait, in order of arrival.
using RosMessages = std::deque<RosMessage>;

/// The topics of a running robot as a source like a bag: at first what was gathered before, which
/// can be read again, then, live, all that comes. Messages of a topic or type that was not among
/// those gathered are left out.
class LiveSource final : public MessageSource {
 public:
  /// Waits for the next message; nothing: there will be no more.
  using Wait = std::function<std::optional<RosMessage>()>;

  /// `gathered` keeps its messages until the source goes live.
  LiveSource(std::shared_ptr<RosMessages> gathered, Wait wait);

  std::string name() const override { return "live topics"; }
  const std::vector<BagConnection>& connections() const override { return connections_; }
  const BagSummary& summary() const override { return summary_; }
  void select(std::span<const std::string> topics) override;
  Result<std::optional<BagMessage>> next() override;
  void rewind() override;

  /// Whether messages of that topic are given.
  bool selects(const std::string& topic) const { return !selected_ || selected_->contains(topic); }

  /// From here on `next` goes on from where it is, and waits for more instead of ending.
  void go_live() { live_ = true; }

 private:
  const BagConnection* find(const RosConnection& connection) const;
  void announce(const RosConnection& connection);
  const RosMessage* following();
  std::optional<BagMessage> given(const RosMessage& message);

  std::shared_ptr<RosMessages> gathered_;
  Wait wait_;
  std::vector<BagConnection> connections_;
  BagSummary summary_;
  std::optional<std::set<std::string>> selected_;  ///< nothing: all topics
  bool live_ = false;
  std::size_t position_ = 0;  ///< among the gathered messages
  RosMessage current_;        ///< the last message that was waited for
  Time last_ = 0;             ///< record time of the last message given
};

}  // namespace aims
