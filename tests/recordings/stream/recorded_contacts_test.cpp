// SPDX-License-Identifier: BSD-3-Clause
// Contacts that are published only when they change.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/recordings/stream/recorded_trot.hpp"

namespace aims {
namespace {

using test::RecordedTrot;
using test::Recording;

constexpr const char* kHeld = "contacts are published only when they change";

void expect_same_legs(const Recording& expected, const Recording& found) {
  ASSERT_EQ(found.error, "");
  const auto all = test::legs_of(expected.deliveries), legs = test::legs_of(found.deliveries);
  ASSERT_GT(all.size(), 390U);
  ASSERT_GE(legs.size() + 1, all.size()) << "the last one waits for contacts of its instant";
  for (std::size_t i = 0; i < legs.size(); ++i) {
    ASSERT_EQ(legs[i].stamp, all[i].stamp);
    ASSERT_EQ(legs[i].contact, all[i].contact) << i;
    ASSERT_EQ(legs[i].linear_velocity, all[i].linear_velocity) << i;
  }
}

TEST_F(RecordedTrot, ContactsOnChangeHoldUntilTheNext) {
  const Recording always = read({.load = 1.0F});
  const Recording on_change = read({.load = 1.0F, .on_change = true});
  EXPECT_FALSE(always.noted(kHeld));
  EXPECT_TRUE(on_change.noted(kHeld));
  expect_same_legs(always, on_change);
}

TEST_F(RecordedTrot, ContactsOfSingleFeetOnChangeHoldUntilTheNext) {
  const Recording always = read({.forces = false, .single_contacts = "/{}_foot/contact"});
  const Recording on_change =
      read({.forces = false, .on_change = true, .single_contacts = "/{}_foot/contact"});
  EXPECT_FALSE(always.noted(kHeld));
  EXPECT_TRUE(on_change.noted(kHeld));
  EXPECT_TRUE(on_change.noted("/foot/contact/contacts: joined from"));
  expect_same_legs(always, on_change);
}

TEST_F(RecordedTrot, ContactsInFieldsThatNameTheFeetAreRead) {
  // As pronto_msgs/QuadrupedStance.
  const Recording stance = read({.forces = false, .stance = true});
  expect_same_legs(read({.load = 1.0F}), stance);
  EXPECT_TRUE(stance.noted("/stance/contacts: joined from /stance, whose fields name the feet"));
}

TEST_F(RecordedTrot, AFootThatDiesIsNotHeld) {
  const Recording dead = read({.single = "/{}/joint_states", .dies = 100});
  EXPECT_FALSE(dead.noted(kHeld));
}

}  // namespace
}  // namespace aims
