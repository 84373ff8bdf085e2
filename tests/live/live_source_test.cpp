// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "recordings/source/decided_start.hpp"

namespace aims {
namespace {

std::shared_ptr<const BagConnection> connection(const std::string& topic,
                                                const std::string& md5 = "m") {
  return std::make_shared<BagConnection>(
      BagConnection{.topic = topic, .type = "a/B", .md5 = md5, .definition = "uint8 x"});
}

/// A message on `topic` whose one byte is `value`.
LiveMessage message(const std::shared_ptr<const BagConnection>& on, Time arrival, int value) {
  return {on, arrival, {static_cast<std::byte>(value)}};
}

/// A network that still has `coming` to give.
struct Network {
  std::deque<LiveMessage> coming;
  LiveSource::Wait wait() {
    return [this]() -> std::optional<LiveMessage> {
      if (coming.empty()) return std::nullopt;
      LiveMessage next = coming.front();
      coming.pop_front();
      return next;
    };
  }
};

/// The bytes of all messages until `next` gives nothing.
std::vector<int> values_of(LiveSource& source) {
  std::vector<int> values;
  for (auto next = source.next(); next && *next; next = source.next()) {
    values.push_back(static_cast<int>((*next)->data[0]));
  }
  return values;
}

class LiveSourceTest : public testing::Test {
 protected:
  std::shared_ptr<const BagConnection> a_ = connection("/a");
  std::shared_ptr<const BagConnection> b_ = connection("/b");
  std::shared_ptr<LiveMessages> gathered_ = std::make_shared<LiveMessages>(
      LiveMessages{message(a_, 10, 1), message(b_, 20, 2), message(a_, 30, 3)});
  Network network_{{message(b_, 40, 4), message(a_, 50, 5)}};
};

TEST_F(LiveSourceTest, AnnouncesTheGatheredTopics) {
  const LiveSource source(gathered_, network_.wait());
  ASSERT_EQ(source.connections().size(), 2U);
  EXPECT_EQ(source.connections()[0].topic, "/a");
  EXPECT_EQ(source.connections()[0].messages, 2U);
  EXPECT_EQ(source.connections()[0].definition, "uint8 x");
  EXPECT_EQ(source.connections()[1].id, 1U);
  EXPECT_EQ(source.summary().start, 10);
  EXPECT_EQ(source.summary().end, 30);
}

TEST_F(LiveSourceTest, CanBeReadAgainUntilItGoesLive) {
  LiveSource source(gathered_, network_.wait());
  EXPECT_EQ(values_of(source), (std::vector{1, 2, 3}));
  source.rewind();
  EXPECT_EQ(values_of(source), (std::vector{1, 2, 3}));
  EXPECT_EQ(gathered_->size(), 3U) << "another attempt needs them";
  EXPECT_EQ(network_.coming.size(), 2U) << "nothing was waited for";
}

TEST_F(LiveSourceTest, GoesLiveFromItsPosition) {
  LiveSource source(gathered_, network_.wait());
  source.next();
  source.go_live();
  EXPECT_EQ(values_of(source), (std::vector{2, 3, 4, 5}));
}

TEST_F(LiveSourceTest, ReturnsAllAfterARewind) {
  LiveSource source(gathered_, network_.wait());
  source.next();
  source.rewind();
  source.go_live();
  EXPECT_EQ(values_of(source), (std::vector{1, 2, 3, 4, 5}));
  EXPECT_TRUE(gathered_->empty()) << "memory is given back";
}

TEST_F(LiveSourceTest, ReturnsSelectedTopicsOnly) {
  LiveSource source(gathered_, network_.wait());
  const std::array<std::string, 2> topics = {"/b", "/absent"};
  source.select(topics);
  EXPECT_TRUE(source.selects("/b"));
  EXPECT_FALSE(source.selects("/a"));
  source.go_live();
  EXPECT_EQ(values_of(source), (std::vector{2, 4}));
}

TEST_F(LiveSourceTest, ShowsAnObserverAllThatIsHeardInOrderAndReturnsWhatIsSelected) {
  LiveSource source(gathered_, network_.wait());
  const std::array<std::string, 1> topics = {"/a"};
  source.select(topics);
  constexpr int kDecided = -1;  // the message behind those that were gathered
  std::vector<int> observed;
  source.go_live([&](const BagMessage& seen) {
    const bool decided = seen.connection->topic == kDecidedTopic;
    observed.push_back(decided ? kDecided : static_cast<int>(seen.data[0]));
  });
  EXPECT_EQ(values_of(source), (std::vector{1, 3, 5}));
  EXPECT_EQ(observed, (std::vector{1, 2, 3, kDecided, 4, 5}));
}

TEST_F(LiveSourceTest, SkipsTopicsAndTypesThatWereNotGathered) {
  network_.coming.push_front(message(connection("/c"), 35, 7));
  network_.coming.push_front(message(connection("/a", "another"), 36, 8));
  // The same publisher, started again: another connection of the same type.
  network_.coming.push_back(message(connection("/a"), 60, 6));
  LiveSource source(gathered_, network_.wait());
  source.go_live();
  EXPECT_EQ(values_of(source), (std::vector{1, 2, 3, 4, 5, 6}));
}

TEST_F(LiveSourceTest, RecordTimesNeverGoBack) {
  network_.coming = {message(a_, 5, 4), message(a_, 70, 5)};
  LiveSource source(gathered_, network_.wait());
  source.go_live();
  std::vector<Time> times;
  for (auto next = source.next(); next && *next; next = source.next()) {
    times.push_back((*next)->record_time);
  }
  EXPECT_EQ(times, (std::vector<Time>{10, 20, 30, 30, 70}));
}

}  // namespace
}  // namespace aims
