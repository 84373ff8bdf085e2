// SPDX-License-Identifier: BSD-3-Clause
#include "live/inbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace aims {
namespace {

LiveMessage message(double arrival_s, std::size_t size) {
  return {nullptr, from_seconds(arrival_s), std::vector<std::byte>(size)};
}

/// The next message that waits.
std::optional<LiveMessage> next_of(Inbox& inbox) {
  return inbox.wait(0.0, [] { return true; });
}

/// Arrival times [s] of what is left.
std::vector<double> arrivals(Inbox& inbox) {
  std::vector<double> times;
  while (auto next = next_of(inbox)) times.push_back(to_seconds(next->arrival));
  return times;
}

TEST(Inbox, KeepsTheOrderOfArrival) {
  Inbox inbox;
  for (const double time : {1.0, 1.5, 1.5, 2.0}) inbox.push(message(time, 10));
  EXPECT_EQ(arrivals(inbox), (std::vector{1.0, 1.5, 1.5, 2.0}));
  EXPECT_EQ(inbox.dropped(), 0U);
  EXPECT_FALSE(next_of(inbox));
}

TEST(Inbox, DropsACloudThatHasWaitedTwoSecondsForANewerOneOfItsTopic) {
  const auto other = std::make_shared<const BagConnection>();
  Inbox inbox;
  inbox.push(message(1.0, 500'000));
  inbox.push({other, kSecond, std::vector<std::byte>(500'000)});
  inbox.push(message(1.1, 100));
  inbox.push(message(1.5, 500'000));
  inbox.push(message(9.0, 100));
  EXPECT_EQ(arrivals(inbox), (std::vector{1.0, 1.1, 1.5, 9.0}));
  EXPECT_EQ(inbox.dropped(), 1U);
}

/// A node that takes messages when it has time for them, of a LiDAR at 10 Hz and an IMU at 200 Hz.
struct BusyNode {
  Inbox inbox;
  int sent = 0;              ///< steps of 5 ms
  std::vector<double> ages;  ///< [s] of the clouds when they were started
  std::size_t imu = 0;

  void receive_until(double time) {
    for (; 0.005 * sent <= time; ++sent) {
      inbox.push(message(0.005 * sent, 100));
      if (sent % 20 == 0) inbox.push(message(0.005 * sent, 500'000));
    }
  }

  /// Until then, when a cloud takes that long.
  void run(double end, double seconds_per_cloud) {
    for (double now = 0.0; now < end;) {
      receive_until(now);
      const auto next = next_of(inbox);
      const bool cloud = next && next->data.size() > Inbox::kLargeSize;
      if (cloud) ages.push_back(now - to_seconds(next->arrival));
      if (next && !cloud) ++imu;
      now += cloud ? seconds_per_cloud : 0.0001;
    }
  }
};

TEST(Inbox, FourTimesTooSlowANodeStartsNoCloudLateAndDropsThreeOfFour) {
  BusyNode node;
  node.inbox.limit_wait(kSecond / 10);
  node.run(60.0, 0.4);
  EXPECT_LE(std::ranges::max(node.ages), 0.1 + 0.005 + 0.01);
  EXPECT_NEAR(static_cast<double>(node.ages.size()), 60.0 / 0.4, 5.0);
  EXPECT_NEAR(static_cast<double>(node.inbox.dropped()), 600.0 - node.ages.size(), 5.0);
  EXPECT_GT(node.imu, 60 * 200 - 100) << "the small ones are all taken";
}

TEST(Inbox, DropsNothingOfANodeThatIsSlowForAMoment) {
  BusyNode node;
  node.inbox.limit_wait(kSecond / 10);
  node.run(60.0, 0.09);
  EXPECT_EQ(node.inbox.dropped(), 0U);
  EXPECT_NEAR(static_cast<double>(node.ages.size()), 600.0, 2.0);
}

TEST(Inbox, BoundsTheMemoryOfANodeThatNeverCatchesUp) {
  Inbox inbox;
  for (int i = 0; i < 20'000; ++i) {  // 100 s at 200 Hz
    inbox.push(message(0.005 * i, 100));
    if (i % 20 == 0) inbox.push(message(0.005 * i, 20'000));
  }
  const std::size_t left = arrivals(inbox).size();
  // The last is from 99.995 s: small ones since 79.995 s, clouds since 97.995 s.
  EXPECT_EQ(left, 4001U + 20U);
  EXPECT_EQ(inbox.dropped() + left, 21'000U);
}

}  // namespace
}  // namespace aims
