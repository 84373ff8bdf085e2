// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/decided_start.hpp"

#include <algorithm>
#include <utility>

namespace aims {
namespace {

bool has_topic(const MessageSource& recording, const char* topic) {
  return std::ranges::find(recording.connections(), topic, &BagConnection::topic) !=
         recording.connections().end();
}

/// The recording behind the message on `kForgottenTopic`, which was recorded at `start`.
class WithoutForgotten final : public MessageSource {
 public:
  WithoutForgotten(std::unique_ptr<MessageSource> recording, Time start)
      : recording_(std::move(recording)), summary_(recording_->summary()) {
    summary_.start = start;
  }

  std::string name() const override { return recording_->name(); }
  const std::vector<BagConnection>& connections() const override {
    return recording_->connections();
  }
  const BagSummary& summary() const override { return summary_; }

  void select(std::span<const std::string> topics) override {
    std::vector<std::string> selected(topics.begin(), topics.end());
    selected.emplace_back(kForgottenTopic);
    recording_->select(selected);
  }

  Result<std::optional<BagMessage>> next() override {
    while (!begun_) {
      auto message = recording_->next();
      if (!message || !*message) return message;
      begun_ = (*message)->connection->topic == kForgottenTopic;
    }
    auto message = recording_->next();
    summary_.repeated_messages = recording_->summary().repeated_messages;
    return message;
  }

  void rewind() override {
    begun_ = false;
    recording_->rewind();
  }

 private:
  std::unique_ptr<MessageSource> recording_;
  BagSummary summary_;
  bool begun_ = false;
};

}  // namespace

bool is_of_live_estimate(const MessageSource& recording) {
  return has_topic(recording, kDecidedTopic);
}

bool has_forgotten(const MessageSource& recording) { return has_topic(recording, kForgottenTopic); }

void DecidedStart::select(std::span<const std::string> topics) {
  std::vector<std::string> selected(topics.begin(), topics.end());
  selected.emplace_back(kDecidedTopic);
  recording_.select(selected);
}

Result<std::optional<BagMessage>> DecidedStart::next() {
  if (ended_) return std::nullopt;
  auto message = recording_.next();
  ended_ = message && *message && (*message)->connection->topic == kDecidedTopic;
  if (ended_) return std::nullopt;
  return message;
}

void DecidedStart::rewind() {
  ended_ = false;
  recording_.rewind();
}

Result<void> leave_out_forgotten(std::unique_ptr<MessageSource>& recording) {
  if (!has_forgotten(*recording)) return {};
  std::vector<std::string> topics = {kForgottenTopic};
  recording->select(topics);
  recording->rewind();
  const auto message = recording->next();
  if (!message) return tl::unexpected(message.error());
  for (const BagConnection& each : recording->connections()) topics.push_back(each.topic);
  recording->select(topics);
  recording->rewind();
  if (!*message) return {};
  const Time start = (*message)->record_time;
  recording = std::make_unique<WithoutForgotten>(std::move(recording), start);
  return {};
}

}  // namespace aims
