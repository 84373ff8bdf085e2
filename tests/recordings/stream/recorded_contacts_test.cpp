// SPDX-License-Identifier: BSD-3-Clause
// Contacts that are published only when they change.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "recordings/legs/leg_survey.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
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

/// What is decided of feet that step in turn with such a force.
struct DecidedContacts {
  ContactRule rule;
  ReadingNotes notes;
  FootLoads last{};  ///< forces, as read
};

DecidedContacts contacts_of(double force, const std::string& field) {
  RecordingConfig config;
  config.contacts_field = field;
  TopicsConfig topics;
  topics.contacts = "/foot_contacts";
  LegSurvey survey(config, topics);
  const MessageType type = foot_contacts_type();
  const auto decoder = MessageDecoder::create(type.name, type.definition, {});
  MessageBytes bytes;
  for (int k = 0; k < 400; ++k) {
    LegOdometrySample sample;
    sample.contact_force.emplace();
    for (std::size_t leg = 0; leg < sample.contact.size(); ++leg) {
      sample.contact[leg] = (k / 20 + static_cast<int>(leg)) % 2 == 0;
      (*sample.contact_force)[leg] = sample.contact[leg] ? force : 0.0;
    }
    bytes = foot_contacts_message({0, k * 20 * kMillisecond, "base"}, sample);
    survey.add_contacts(*decoder->decode(bytes.view()), type.name, *decoder, nullptr);
  }
  DecidedContacts decided;
  decided.rule = survey.decide_contacts(decided.notes).value();
  decided.last = forces_at(*decoder->decode(bytes.view()), decided.rule).value_or(FootLoads{});
  return decided;
}

TEST(ContactForces, OfTheReversedSignAreReadByTheirMagnitude) {
  for (const char* field : {"force", "contact"}) {
    EXPECT_EQ(contacts_of(-80.0, field).last, contacts_of(80.0, field).last) << field;
    EXPECT_EQ(std::ranges::max(contacts_of(-80.0, field).last), 80.0) << field;
  }
}

TEST(ContactForces, AConfiguredFieldThatTheMessageLacksIsNamed) {
  const auto decided = contacts_of(80.0, "frce");
  ASSERT_FALSE(decided.notes.notes.empty());
  EXPECT_EQ(decided.notes.notes[0],
            "/foot_contacts: no field 'frce' (contacts_field), but contact, force");
}

}  // namespace
}  // namespace aims
