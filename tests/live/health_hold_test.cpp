// SPDX-License-Identifier: BSD-3-Clause
#include "live/health_hold.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

using Reasons = std::vector<std::string>;

HealthRow row(double seconds, HealthState state, Reasons reasons = {}) {
  return {from_seconds(seconds), state, std::move(reasons), 0.1};
}

TEST(HealthHold, WhatComesAndGoesStaysForFiveSeconds) {
  HealthHold hold;
  EXPECT_EQ(hold.held(row(1.0, HealthState::kHealthy)).state, HealthState::kHealthy);
  EXPECT_EQ(hold.held(row(2.0, HealthState::kDegraded, {"no legs"})).reasons, Reasons{"no legs"});
  const HealthRow after = hold.held(row(7.0, HealthState::kHealthy));
  EXPECT_EQ(after.state, HealthState::kDegraded);
  EXPECT_EQ(after.reasons, Reasons{"no legs"});
  EXPECT_EQ(after.stamp, from_seconds(7.0));
  EXPECT_EQ(hold.held(row(7.1, HealthState::kHealthy)).state, HealthState::kHealthy);
}

TEST(HealthHold, ReasonsThatAlternateAreOneState) {
  HealthHold hold;
  HealthRow last = hold.held(row(0.0, HealthState::kDegraded, {"1 dropped", "no legs"}));
  hold.held(row(0.1, HealthState::kInvalid, {"uncertain"}));
  last = hold.held(row(0.2, HealthState::kDegraded, {"2 dropped"}));
  EXPECT_EQ(last.state, HealthState::kInvalid);
  EXPECT_EQ(last.reasons, (Reasons{"2 dropped", "uncertain", "no legs"}));
  const HealthRow next = hold.held(row(0.3, HealthState::kDegraded, {"no legs", "13 dropped"}));
  EXPECT_TRUE(alike(last, next)) << "nothing to print";
  EXPECT_FALSE(alike(last, row(0.3, HealthState::kInvalid, {"uncertain"})));
}

TEST(HealthHold, TheStartIsNotHeld) {
  HealthHold hold;
  hold.held(row(0.0, HealthState::kStarting, {"waiting"}));
  const HealthRow first = hold.held(row(1.0, HealthState::kHealthy));
  EXPECT_EQ(first.state, HealthState::kHealthy);
  EXPECT_TRUE(first.reasons.empty());
}

}  // namespace
}  // namespace aims
