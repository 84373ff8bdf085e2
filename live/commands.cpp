// SPDX-License-Identifier: BSD-3-Clause
#include "live/commands.hpp"

#include <fmt/format.h>

#include <atomic>
#include <csignal>
#include <utility>

#include "core/text.hpp"
#include "live/program.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

constexpr double kSilence = 1.0;  ///< [s]

std::atomic<bool> signalled_save{false};
std::atomic<bool> signalled_calibrate{false};
static_assert(std::atomic<bool>::is_always_lock_free);

/// The text of a std_msgs/String; empty for what is none.
std::string text_of(const LiveMessage& message) {
  const BagConnection& from = *message.connection;
  const auto decoder = MessageDecoder::create(from.type, from.definition, from.format);
  if (!decoder) return {};
  const auto view = decoder->decode(message.data);
  return view ? std::string(view->text("data").value_or("")) : "";
}

}  // namespace

Commands::Commands(Transport& transport)
    : transport_(transport), topic_(transport.resolved("~command")) {
  std::signal(SIGUSR1, [](int) { signalled_save = true; });
  std::signal(SIGUSR2, [](int) { signalled_calibrate = true; });
  transport_.subscribe(topic_, string_type().name);
}

std::optional<LiveMessage> Commands::wait(double seconds) {
  auto message = transport_.wait(seconds);
  while (message && message->connection->topic == topic_) {
    take(*message);
    message = transport_.wait(0.0);
  }
  take_signals();
  note_silence(!message);
  return message;
}

void Commands::note_silence(bool silent) {
  if (!silent) {
    since_message_ = Stopwatch();
    told_ = 0.0;
  } else if (silence_ && since_message_.seconds() > told_ + kSilence) {
    told_ = since_message_.seconds();
    silence_(told_);
  }
}

void Commands::take_signals() {
  if (signalled_save.exchange(false)) save_map();
  if (signalled_calibrate.exchange(false)) restart_ = LiveRequest::kCalibrate;
}

void Commands::take(const LiveMessage& message) {
  const std::string text = text_of(message);
  if (text == "reset") {
    restart_ = LiveRequest::kReset;
  } else if (text == "calibrate") {
    restart_ = LiveRequest::kCalibrate;
  } else if (text == "save_map") {
    save_map();
  } else {
    print_line(fmt::format("warning: {}: expected reset, calibrate or save_map, got '{}'", topic_,
                           line_text(text)));
  }
}

void Commands::save_map() const {
  if (save_) return save_();
  print_line("warning: save_map: no map yet");
}

}  // namespace aims
