// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "recordings/bag/wrapped_source.hpp"
#include "recordings/messages/message_bytes.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

/// A recording with further topics, whose messages are made of recorded ones.
class DerivedSource : public WrappedSource {
 public:
  void select(std::span<const std::string> topics) override;
  Result<std::optional<BagMessage>> next() override;
  void rewind() override;

 protected:
  explicit DerivedSource(std::unique_ptr<MessageSource> source);

  /// Adds a topic, made of the messages of `from`; of these many messages. Where the recording has
  /// a topic of that type elsewhere, this one is only chosen by its name, unless it is made of no
  /// message. `joined_from`: what it is made of, in words.
  std::uint32_t add_topic(std::string topic, const MessageType& type, std::uint64_t messages,
                          const std::set<std::uint32_t>& from, std::string joined_from = {});

  /// Marks connections as parts of a topic that is made; yields the number of their messages.
  std::uint64_t mark_parts(const std::set<std::uint32_t>& ids);

  /// Gives a made message.
  void give(std::uint32_t id, Time record_time, MessageBytes bytes);

  /// Sees each message that a wanted topic is made of.
  virtual Result<void> see(const BagMessage& message) = 0;

  /// Gives what is left at the end, which for a running robot comes again and again; `last`: record
  /// time of the last message.
  virtual void finish(Time /*last*/) {}

  /// Forgets what was seen.
  virtual void restart() {}

 private:
  struct Made {
    std::uint32_t id = 0;
    Time time = 0;
    MessageBytes bytes;
  };

  std::optional<BagMessage> take();

  std::set<std::uint32_t> recorded_, wanted_, seen_;  ///< connections
  std::map<std::uint32_t, std::set<std::uint32_t>> from_;
  std::deque<Made> made_;
  std::optional<Made> lent_;  ///< that the caller has
  Time last_;                 ///< record time of the last message
};

}  // namespace aims
