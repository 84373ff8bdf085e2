// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/decided_start.hpp"

#include <algorithm>
#include <utility>

#include "core/text.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {
namespace {

bool has_topic(const MessageSource& recording, const char* topic) {
  return std::ranges::find(recording.connections(), topic, &BagConnection::topic) !=
         recording.connections().end();
}

/// The recording behind the message on `kForgottenTopic`, which was recorded at `start`.
class WithoutForgotten final : public WrappedSource {
 public:
  WithoutForgotten(std::unique_ptr<MessageSource> recording, Time start)
      : WrappedSource(std::move(recording)) {
    summary_ = source_.summary();
    summary_->start = start;
  }

  void select(std::span<const std::string> topics) override {
    std::vector<std::string> selected(topics.begin(), topics.end());
    selected.emplace_back(kForgottenTopic);
    WrappedSource::select(selected);
  }

  Result<std::optional<BagMessage>> next() override {
    while (!begun_) {
      auto message = read();
      if (!message || !*message) return message;
      begun_ = (*message)->connection->topic == kForgottenTopic;
    }
    return read();
  }

  void rewind() override {
    begun_ = false;
    WrappedSource::rewind();
  }

 private:
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
  WrappedSource::select(selected);
}

Result<std::optional<BagMessage>> DecidedStart::next() {
  if (ended_) return std::nullopt;
  auto message = read();
  ended_ = message && *message && (*message)->connection->topic == kDecidedTopic;
  if (ended_) return std::nullopt;
  return message;
}

void DecidedStart::rewind() {
  ended_ = false;
  WrappedSource::rewind();
}

Result<std::vector<std::string>> doubled_topics(MessageSource& recording) {
  std::vector<std::string> found;
  if (!has_topic(recording, kDoubledTopic)) return found;
  recording.select(std::vector<std::string>{kDoubledTopic});
  recording.rewind();
  auto message = recording.next();
  for (; message && *message; message = recording.next()) {
    const BagConnection& from = *(*message)->connection;
    const auto decoder = MessageDecoder::create(from.type, from.definition, from.format);
    if (!decoder) continue;
    const auto view = decoder->decode((*message)->data);
    if (!view) continue;
    found.push_back(line_text(std::string(view->text("data").value_or(""))));
  }
  start_anew(recording);
  if (!message) return tl::unexpected(message.error());
  return found;
}

Result<void> leave_out_forgotten(std::unique_ptr<MessageSource>& recording) {
  if (!has_forgotten(*recording)) return {};
  recording->select(std::vector<std::string>{kForgottenTopic});
  recording->rewind();
  const auto message = recording->next();
  if (!message) return tl::unexpected(message.error());
  start_anew(*recording);
  if (!*message) return {};
  const Time start = (*message)->record_time;
  recording = std::make_unique<WithoutForgotten>(std::move(recording), start);
  return {};
}

}  // namespace aims
