// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "live/transport.hpp"
#include "recordings/source/recording_file.hpp"

namespace aims::test {

/// Plays a recording: a second of it each time that the topics are asked for.
class PlayedTransport : public Transport {
 public:
  explicit PlayedTransport(const std::filesystem::path& file) {
    auto source = open_recording(file);
    EXPECT_TRUE(source) << source.error().message;
    std::vector<std::shared_ptr<const BagConnection>> connections;
    for (const BagConnection& each : (*source)->connections()) {
      connections.push_back(std::make_shared<BagConnection>(each));
      topics_[each.topic] = each.type;
    }
    for (auto next = (*source)->next(); next && *next; next = (*source)->next()) {
      coming_.push_back({connections[(*next)->connection->id],
                         (*next)->record_time,
                         {(*next)->data.begin(), (*next)->data.end()}});
    }
    horizon_ = coming_.front().arrival;
  }

  MessageFormat format() const override { return kRos1Format; }
  bool running() const override { return !coming_.empty(); }
  bool preceded(const std::string&) override { return false; }
  std::map<std::string, std::string> topics() override {
    horizon_ += kSecond;
    return topics_;
  }
  std::string resolved(const std::string& topic) const override { return topic; }
  void subscribe(const std::string&, const std::string&) override {}
  void unsubscribe(const std::string&) override {}
  std::optional<LiveMessage> wait(double) override {
    if (coming_.empty() || (coming_.front().arrival > horizon_ && !at_once_)) return std::nullopt;
    LiveMessage message = std::move(coming_.front());
    coming_.pop_front();
    return message;
  }
  std::size_t advertise(const std::string&, const MessageType&, bool) override { return 0; }
  bool heard(std::size_t) const override { return false; }
  void publish(std::size_t, std::span<const std::byte>) override {}

  /// Gives the rest without being asked.
  void play_all() { at_once_ = true; }

 protected:
  std::map<std::string, std::string> topics_;
  std::deque<LiveMessage> coming_;
  Time horizon_ = 0;
  bool at_once_ = false;
};

}  // namespace aims::test
