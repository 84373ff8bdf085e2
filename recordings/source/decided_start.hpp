// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/bag/wrapped_source.hpp"

namespace aims {

/// Topic of the message that a live estimate records once it has decided topics, units and clocks.
inline constexpr const char* kDecidedTopic = "/aims/decided";

/// Topic of the message behind what a live estimate had heard, but no longer had when it decided.
inline constexpr const char* kForgottenTopic = "/aims/forgotten";

/// Topic of the messages by which it says that topics had several publishers.
inline constexpr const char* kDoubledTopic = "/aims/doubled";

/// Whether the topic is one of these.
inline bool is_mark(std::string_view topic) {
  return topic == kDecidedTopic || topic == kForgottenTopic || topic == kDoubledTopic;
}

/// Whether a live estimate made the recording.
bool is_of_live_estimate(const MessageSource& recording);

/// The recording up to the message on `kDecidedTopic`: what a live estimate had when it decided.
class DecidedStart final : public WrappedSource {
 public:
  /// `recording` must outlive it.
  explicit DecidedStart(MessageSource& recording) : WrappedSource(recording) {}

  void select(std::span<const std::string> topics) override;
  Result<std::optional<BagMessage>> next() override;
  void rewind() override;

 private:
  bool ended_ = false;
};

/// Whether it had to forget something.
bool has_forgotten(const MessageSource& recording);

/// What a live estimate says of topics with several publishers: "/imu/data has 2 publishers".
Result<std::vector<std::string>> doubled_topics(MessageSource& recording);

/// Leaves out what is before the message on `kForgottenTopic`, if there is one.
Result<void> leave_out_forgotten(std::unique_ptr<MessageSource>& recording);

}  // namespace aims
