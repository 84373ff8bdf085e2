// SPDX-License-Identifier: BSD-3-Clause
// Of the survey of the legs: contacts of the feet.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "recordings/legs/leg_survey.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

/// Feet that may be without a threshold of contact: three others carry the estimate.
constexpr std::size_t kMostUnknownFeet = 1;

bool are_same(const FootLoads& a, const FootLoads& b) {
  return std::ranges::equal(a, b, [](double each, double other) {
    return each == other || (std::isnan(each) && std::isnan(other));
  });
}

/// The fields of several numbers, by name.
std::string number_fields_of(const MessageDecoder& decoder) {
  std::vector<std::string> fields;
  for (const MessageField& field : decoder.fields()) {
    if (field.kind == FieldKind::kNumbers) fields.push_back(field.path);
  }
  return fmt::format("{}", fmt::join(fields, ", "));
}

/// The array of "array[].field"; the whole path without.
std::string_view array_of(std::string_view path) { return path.substr(0, path.find("[]")); }

/// The field of the torques beside the angles of the joints; empty without.
std::string torques_beside(const MessageView& message, const StateLayout& state) {
  if (!state.has_joints() || !state.joint_names.empty()) return {};
  for (const std::string_view name : {"tau_est", "tauEst", "tau", "torque", "effort"}) {
    std::string field = fmt::format("{}[].{}", array_of(state.angles), name);
    if (numbers_at(message, field)) return field;
  }
  return {};
}

}  // namespace

void LegSurvey::choose_contact_field(const std::string& type, const MessageDecoder& decoder,
                                     const StateLayout* state) {
  contact_field_ = config_.contacts_field;
  if (state != nullptr && (contact_field_.empty() || contact_field_ == state->contacts)) {
    contact_field_ = state->contacts;
    contact_state_ = state;
    contacts_are_flags_ = state->contact_kind == ContactKind::kState;
    contacts_are_raw_ = !contacts_are_flags_;
    if (!state->foot_names.empty() || !config_.foot_names.empty()) return;
    for (const int leg : state->legs) {
      config_.foot_names.emplace_back(kLegNames[static_cast<std::size_t>(leg)]);
    }
    return;
  }
  if (state != nullptr && state->has_joints() && state->joint_names.empty() &&
      array_of(contact_field_) == array_of(state->angles)) {
    contact_knees_ = state;
    contacts_are_raw_ = true;
    return;
  }
  const bool joints = type == "sensor_msgs/JointState";
  contacts_are_raw_ = type == kFootForces || joints;
  if (contact_field_.empty() && joints) contact_field_ = "effort";
  for (const MessageField& field : decoder.fields()) {
    if (field.kind != FieldKind::kNumbers) continue;
    if (contact_field_.empty()) contact_field_ = field.path;
    if (field.path == contact_field_) contacts_are_flags_ = field.is_bool;
  }
}

void LegSurvey::add_contacts(const MessageView& message, const std::string& type,
                             const MessageDecoder& decoder, const StateLayout* state) {
  if (contact_field_.empty()) {
    choose_contact_field(type, decoder, state);
    if (contact_state_ != nullptr) torque_field_ = torques_beside(message, *contact_state_);
  }
  const auto loads = loads_at(message, rule_of(0.0));
  if (!loads && !config_.contacts_field.empty() && !numbers_at(message, contact_field_)) {
    number_fields_ = number_fields_of(decoder);
  }
  if (!loads) return;
  ++contact_messages_;
  if (!first_loads_.empty() && are_same(first_loads_.back(), *loads)) ++repeated_contacts_;
  first_loads_.push_back(*loads);
  if (const auto forces = forces_at(message, rule_of(0.0))) first_forces_.push_back(*forces);
  feet_unnamed_ = feet_unnamed_ || !feet_are_named(message, rule_of(0.0));
  for (const double load : *loads) {
    if (std::isfinite(load)) largest_load_ = std::max(largest_load_, std::abs(load));
  }
}

bool LegSurvey::learns_contacts() const {
  if (contact_messages_ == 0 || contacts_are_flags_) return false;
  if (config_.contact_detection == ContactDetection::kAuto) return contacts_are_raw_;
  return config_.contact_detection == ContactDetection::kLearned;
}

void LegSurvey::add_loads(const MessageView& message) {
  if (const auto loads = loads_at(message, rule_of(0.0))) loads_.push_back(*loads);
}

ContactRule LegSurvey::rule_of(double threshold) const {
  ContactRule rule = {contact_field_, {}, config_.foot_names, contact_state_, contact_knees_};
  rule.thresholds.fill({threshold, threshold});
  return rule;
}

/// What to do where the loads tell no contacts.
std::string LegSurvey::advice_on_contacts() const {
  const bool silent =
      std::ranges::all_of(loads_, [this](const FootLoads& each) { return each == loads_.front(); });
  if (!silent) return "; set contact_detection: threshold with contact_threshold";
  return fmt::format(
      ": the loads are always {:g}, as without sensors in the feet{}",
      loads_.empty() ? 0.0 : loads_.front()[0],
      torque_field_.empty()
          ? ""
          : fmt::format("; take the torques of the knees: set recording.contacts_field={}",
                        torque_field_));
}

Result<ContactRule> LegSurvey::learned_rule(ReadingNotes& notes) const {
  ContactRule rule = rule_of(std::numeric_limits<double>::infinity());
  std::vector<std::string> unknown;
  std::string list;
  for (std::size_t leg = 0; leg < rule.thresholds.size(); ++leg) {
    const auto learned = learn_contact_threshold(loads_, leg);
    list += list.empty() ? "" : ", ";
    list += learned ? fmt::format("{:.1f}/{:.1f}", learned->begin, learned->end) : "-";
    if (learned) rule.thresholds[leg] = *learned;
    if (!learned) unknown.push_back(learned.error().message);
  }
  const std::string where = fmt::format(
      "topic '{}', field '{}': no threshold of contact can be "
      "learned: {}",
      topics_.contacts, contact_field_, fmt::join(unknown, "; "));
  if (unknown.size() > kMostUnknownFeet) {
    return failure(where + advice_on_contacts());
  }
  if (!unknown.empty()) {
    notes.warn("contacts of a foot not learned", where + "; no contact of this foot is used");
  }
  notes.push_back(
      fmt::format("{}: contacts begin/end at '{}' of {} (FL, FR, RL, RR), learned from "
                  "{} messages (contact_detection)",
                  topics_.contacts, contact_field_, list, loads_.size()));
  if (config_.contact_threshold != RecordingConfig().contact_threshold) {
    notes.push_back(
        fmt::format("{}: recording.contact_threshold={:g} is not used, since thresholds are "
                    "learned: set recording.contact_detection=threshold too",
                    topics_.contacts, config_.contact_threshold));
  }
  return rule;
}

ContactRule LegSurvey::without_contacts(const std::string& reason, ReadingNotes& notes) {
  lack_ = reason;
  contact_messages_ = 0;
  notes.warn("contacts of the feet not learned", reason + ": no contacts are used");
  return rule_of(std::numeric_limits<double>::infinity());
}

/// Whether the loads are torques of the knees, of either sign.
bool LegSurvey::loads_are_torques() const {
  const auto named = [this](std::string_view part) {
    return contact_field_.find(part) != std::string::npos;
  };
  const bool of_state =
      contact_state_ != nullptr && contact_state_->contact_kind == ContactKind::kTorque;
  return of_state || named("effort") || named("torque") || named("tau");
}

/// Of loads whose sign tells something; else all are as they should be.
std::array<LoadRange, kLegCount> LegSurvey::ranges_of_loads() const {
  constexpr double kCounts = 1.0, kParts = 0.1;  // negligible, of counts and of fractions
  if (contacts_are_flags_ || loads_are_torques()) return {};
  if (!loads_.empty()) return load_ranges(loads_, kCounts);
  return load_ranges(first_loads_, largest_load_ <= 1.0 ? kParts : config_.contact_threshold);
}

/// Of the feet whose loads tell no contact; empty without.
std::string LegSurvey::offset_text(const std::array<LoadRange, kLegCount>& ranges) const {
  const std::string feet = feet_text(ranges, LoadSign::kUnclear);
  if (feet.empty()) return {};
  return fmt::format(
      "{}: the loads of {} are negative, but not between zero and negative as of a reversed sign: "
      "the sensor has an offset; take it off in the driver",
      topics_.contacts, feet);
}

/// The rule with the sign that the loads have, without the feet whose loads tell no contact.
Result<ContactRule> LegSurvey::with_signs(ContactRule rule, ReadingNotes& notes) const {
  const auto ranges = ranges_of_loads();
  const std::string reversed = feet_text(ranges, LoadSign::kNegative);
  const std::string offset = offset_text(ranges);
  if (!reversed.empty()) {
    notes.warn("loads of the feet are negative",
               fmt::format("{}: the loads of {} are negative: taken as of the reversed sign",
                           topics_.contacts, reversed));
  }
  const auto is_unclear = [](const LoadRange& each) { return each.sign == LoadSign::kUnclear; };
  if (std::ranges::all_of(ranges, is_unclear)) return failure(offset);
  if (!offset.empty()) {
    notes.warn("loads of the feet have an offset", offset + "; no contact of these feet is used");
  }
  const bool by_threshold = loads_.empty() && !contacts_are_flags_ && !loads_are_torques();
  for (std::size_t leg = 0; leg < ranges.size(); ++leg) {
    ContactThreshold& threshold = rule.thresholds[leg];
    if (by_threshold) threshold.sign = ranges[leg].sign == LoadSign::kNegative ? -1 : 1;
    if (is_unclear(ranges[leg])) {
      threshold.begin = threshold.end = std::numeric_limits<double>::infinity();
    }
  }
  return rule;
}

Result<ContactRule> LegSurvey::decide_contacts(ReadingNotes& notes) {
  auto rule = rule_of_loads(notes);
  if (topics_.contacts.empty() || contact_messages_ == 0) return rule;
  const std::string offset = rule ? "" : offset_text(ranges_of_loads());
  if (!offset.empty()) return failure(offset);
  contacts_unknown_ = !rule;
  if (!rule) return rule;
  rule = with_signs(std::move(*rule), notes);
  if (!rule) return rule;
  const auto forces = load_ranges(first_forces_, config_.contact_threshold);
  for (std::size_t leg = 0; leg < forces.size(); ++leg) {
    rule->force_signs[leg] = forces[leg].sign == LoadSign::kNegative ? -1.0 : 1.0;
  }
  return rule;
}

bool LegSurvey::contacts_hold(ReadingNotes& notes) const {
  constexpr int kFewRepeats = 10, kFewer = 3;  // one of so many; than joints or feet
  const bool flags = contacts_are_flags_ || largest_load_ <= 1.0;
  const int legs = std::max(joint_messages_, foot_messages_);
  if (!flags || contact_messages_ == 0 || kFewer * contact_messages_ > legs) return false;
  if (kFewRepeats * repeated_contacts_ > contact_messages_) return false;
  notes.warn("contacts only on change",
             fmt::format("{}: contacts are published only when they change, {} messages at the "
                         "start: the last ones hold until the next; where messages are lost, feet "
                         "stay as they were",
                         topics_.contacts, contact_messages_));
  return true;
}

Result<ContactRule> LegSurvey::rule_of_loads(ReadingNotes& notes) const {
  ContactRule rule = rule_of(config_.contact_threshold);
  if (topics_.contacts.empty()) return rule;
  if (contact_messages_ == 0 && !number_fields_.empty()) {
    notes.push_back(fmt::format("{}: no field '{}' (contacts_field), but {}", topics_.contacts,
                                contact_field_, number_fields_));
    return rule;
  }
  if (contact_messages_ == 0) {
    notes.push_back(fmt::format(
        "{}: field '{}' does not name four feet: no contacts (contacts_field, foot_names)",
        topics_.contacts, contact_field_));
    return rule;
  }
  if (learns_contacts()) {
    auto learned = learned_rule(notes);
    const bool asked = config_.contact_detection == ContactDetection::kLearned;
    if (learned || asked || contact_field_ != "effort") return learned;
    notes.warn("threshold of contact assumed",
               fmt::format("{}: contact from {} of the knee's torque on: no other threshold can be "
                           "learned (contact_threshold)",
                           topics_.contacts, config_.contact_threshold));
  }
  const bool asked = config_.contact_detection == ContactDetection::kThreshold;
  if (!contacts_are_flags_ && (asked || largest_load_ > 1.0)) return rule;
  rule = rule_of(0.5);
  if (!contacts_are_flags_) {
    notes.push_back(fmt::format("{}: '{}' is at most 1 at the start: a flag, threshold 0.5",
                                topics_.contacts, contact_field_));
  }
  return rule;
}

}  // namespace aims
