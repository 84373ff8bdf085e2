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

#include "live/clock_watch.hpp"
#include "live/inbox.hpp"
#include "recordings/bag/message_source.hpp"
#include "recordings/source/message_stamps.hpp"
#include "recordings/stream/recording_reader.hpp"

namespace aims {

/// Queued messages, in order of arrival.
using LiveMessages = std::deque<LiveMessage>;

/// The topics of a running robot as a message source. At first it contains the gathered messages,
/// which can be read again; once live, it continues with new ones. Messages of topics or types that
/// were not gathered are skipped.
class LiveSource final : public MessageSource {
 public:
  /// Waits for the next message; nothing when there are no more.
  using Wait = std::function<std::optional<LiveMessage>()>;
  /// Sees messages in the order in which they are read.
  using Observer = std::function<void(const BagMessage&)>;

  /// `gathered` keeps its messages until the source goes live.
  LiveSource(std::shared_ptr<LiveMessages> gathered, Wait wait);

  std::string name() const override { return "live topics"; }
  const std::vector<BagConnection>& connections() const override { return connections_; }
  const BagSummary& summary() const override { return summary_; }
  void select(std::span<const std::string> topics) override;
  Result<std::optional<BagMessage>> next() override;
  void rewind() override;

  /// Whether messages of that topic are returned.
  bool selects(const std::string& topic) const { return !selected_ || selected_->contains(topic); }

  /// Makes `next` wait for new messages after the gathered ones instead of ending. `observer` sees
  /// all messages of the gathered topics, selected or not, and behind the gathered ones one on
  /// `kDecidedTopic`. `clocks` judges the stamps of the selected ones: once it is broken, `next`
  /// ends; it must outlive the source.
  void go_live(Observer observer = {}, ClockWatch* clocks = nullptr);

  /// Shows the gathered messages.
  void show(const Observer& observer);

 private:
  BagConnection* find(const BagConnection& connection);
  void announce(const BagConnection& connection);
  const LiveMessage* following();
  bool goes_on(const BagMessage& recorded, Time arrival);
  BagMessage as_recorded(const LiveMessage& message, const BagConnection& connection);

  std::shared_ptr<LiveMessages> gathered_;
  Wait wait_;
  std::vector<BagConnection> connections_;
  BagSummary summary_;
  std::optional<std::set<std::string>> selected_;  ///< nothing: all topics
  bool live_ = false;
  Observer observer_;
  ClockWatch* clocks_ = nullptr;
  std::optional<MessageStamps> stamps_;  ///< for the clocks
  std::size_t position_ = 0;             ///< among the gathered messages
  LiveMessage current_;                  ///< the last message that was waited for
  Time last_ = 0;                        ///< record time of the last message read
};

/// Shows the observer a message without a publisher, whose topic says what it marks.
void show_mark(const LiveSource::Observer& observer, const char* topic, Time record_time,
               MessageFormat format, const std::string& text = "by a live estimate");

/// Opens the topics as those of a recording are: the halves of an IMU, and legs in messages of
/// their own, are joined. `source` lives as long as the reader.
Result<RecordingReader> open_live(std::unique_ptr<LiveSource> source,
                                  const RecordingConfig& config);

}  // namespace aims
