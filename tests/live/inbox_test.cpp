// SPDX-License-Identifier: BSD-3-Clause
#include "live/inbox.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace aims {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

LiveMessage message(double arrival_s, std::size_t size) {
  return {nullptr, static_cast<std::int64_t>(arrival_s * kSecondNs), std::vector<std::byte>(size)};
}

/// Arrival times [s] of what is left.
std::vector<double> arrivals(Inbox& inbox) {
  std::vector<double> times;
  while (auto next = inbox.pop()) times.push_back(static_cast<double>(next->arrival) / kSecondNs);
  return times;
}

TEST(Inbox, KeepsTheOrderOfArrival) {
  Inbox inbox;
  for (const double time : {1.0, 1.5, 1.5, 2.0}) inbox.push(message(time, 10));
  EXPECT_EQ(arrivals(inbox), (std::vector{1.0, 1.5, 1.5, 2.0}));
  EXPECT_EQ(inbox.dropped(), 0U);
  EXPECT_FALSE(inbox.pop());
}

TEST(Inbox, DropsCloudsThatHaveWaitedTwoSeconds) {
  Inbox inbox;
  inbox.push(message(1.0, 500'000));
  inbox.push(message(1.1, 100));
  inbox.push(message(1.5, 500'000));
  inbox.push(message(3.2, 100));
  EXPECT_EQ(arrivals(inbox), (std::vector{1.1, 1.5, 3.2}));
  EXPECT_EQ(inbox.dropped(), 1U);
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
