// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_survey.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxListed = 200;  ///< of names in messages [bytes]
constexpr double kLargeAngle = 6.5;      ///< of no joint of a leg [rad]
/// Feet that may be without a threshold of contact: three others carry the estimate.
constexpr std::size_t kMostUnknownFeet = 1;

}  // namespace

bool is_world_frame(const std::string& frame) {
  return frame.find("odom") != std::string::npos || frame.find("map") != std::string::npos ||
         frame.find("world") != std::string::npos || frame.find("camera_init") != std::string::npos;
}

void LegSurvey::add_joints(const MessageView& message, Time record_time, const StateLayout* state) {
  ++joint_messages_;
  joint_rule_.state = state;
  if (joints_at(message, record_time, joint_rule_)) {
    ++complete_joint_messages_;
  } else if (config_.joint_names.empty() && unnamed_joints_at(message, joint_rule_)) {
    ++unnamed_joint_messages_;
  }
  add_angles(message, record_time);
  if (joint_names_.empty()) {
    const auto names = joint_names_at(message, state);
    joint_names_ = fmt::format("{}", fmt::join(names, ", ")).substr(0, kMaxListed);
    joints_assumed_ = config_.joint_names.empty() && names_tell_legs_alone(names);
    const auto first = names.empty() ? std::nullopt : leg_of_name(names.front());
    joints_of_one_leg_ = first && std::ranges::all_of(names, [&](std::string_view name) {
                           return leg_of_name(name) == first;
                         });
  }
  if (const auto effort = message.numbers("effort"); effort && !effort->empty()) ++effort_messages_;
}

/// Notes angles that are too large for a leg.
void LegSurvey::add_angles(const MessageView& message, Time record_time) {
  const auto large = [](double each) { return std::abs(each) > kLargeAngle; };
  if (const auto joints = joints_at(message, record_time, joint_rule_)) {
    if (std::ranges::any_of(joints->position, large)) ++large_angles_;
  } else if (const auto unnamed = unnamed_joints_at(message, joint_rule_)) {
    if (std::ranges::any_of(unnamed->angles, large)) ++large_angles_;
  }
}

void LegSurvey::warn_of_degrees(ReadingNotes& notes) const {
  if (2 * large_angles_ <= complete_joint_messages_ + unnamed_joint_messages_) return;
  notes.warn("joint angles perhaps in degrees",
             fmt::format("{}: angles beyond {} rad, which no leg reaches: are they in degrees? "
                         "Then set recording.joint_unit=deg",
                         topics_.joint_states, kLargeAngle));
}

/// Why the joints are not identified.
std::string LegSurvey::lack_of_joints() const {
  if (joint_rule_.state != nullptr && joint_rule_.state->joint_names.empty()) {
    return fmt::format("{}: expected twelve joints or more in '{}'", topics_.joint_states,
                       joint_rule_.state->angles);
  }
  if (joint_names_.empty()) {
    return fmt::format(
        "{}: the joints have no names: set recording.joint_names to the twelve "
        "indices of FL, FR, RL, RR: abduction, hip, knee",
        topics_.joint_states);
  }
  if (joints_of_one_leg_) {
    return fmt::format(
        "{}: each message holds the joints of one leg ({}): expected those of all four in one "
        "message; join them before",
        topics_.joint_states, joint_names_);
  }
  return fmt::format("{}: the names do not identify the twelve joints (joint_names): {}",
                     topics_.joint_states, joint_names_);
}

/// What to do where joints have no contacts.
std::string LegSurvey::lack_of_contacts() const {
  const std::string torques =
      effort_messages_ == 0 || topics_.contacts == topics_.joint_states
          ? ""
          : fmt::format(", or take the torques of the knees (--topics contacts={})",
                        topics_.joint_states);
  const std::string found =
      topics_.contacts.empty() ? "no contacts of the feet are found"
                               : fmt::format("{} holds no contacts of four feet", topics_.contacts);
  return fmt::format(
      "{} has joints, but {}: name a topic with a number for each foot "
      "(--topics contacts=/...){}",
      topics_.joint_states, found, torques);
}

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
  if (contact_field_.empty()) choose_contact_field(type, decoder, state);
  const auto loads = loads_at(message, rule_of(0.0));
  if (!loads) return;
  ++contact_messages_;
  first_loads_.push_back(*loads);
  feet_unnamed_ = feet_unnamed_ || !feet_are_named(message, rule_of(0.0));
  for (const double load : *loads) {
    if (std::isfinite(load)) largest_load_ = std::max(largest_load_, std::abs(load));
  }
}

void LegSurvey::add_joint_motion(const MessageView& message, Time record_time) {
  const Time stamp = header_stamp(message, record_time);
  const Time time = stamp == 0 ? record_time : stamp;
  // Names that are configured or recorded go first.
  const auto joints = joints_at(message, record_time, joint_rule_);
  if (!joints) {
    const auto unnamed = unnamed_joints_at(message, joint_rule_);
    if (unnamed) order_finder_.add_joints(time, unnamed->angles, unnamed->rates);
    return;
  }
  const auto& q = joints->position;
  std::vector<double> rates;
  if (joints->velocity) rates.assign(joints->velocity->begin(), joints->velocity->end());
  order_finder_.add_joints(time, {q.begin(), q.end()}, rates);
}

void LegSurvey::add_load_motion(const MessageView& message) {
  if (const auto loads = loads_at(message, rule_of(0.0))) order_finder_.add_loads(*loads);
}

void LegSurvey::decide_order(const Eigen::Quaterniond& R_body_base, ReadingNotes& notes) {
  if (!needs_order()) return;
  const bool unnamed = has_unnamed_joints();
  JointOrder by_name;
  for (std::size_t i = 0; i < by_name.size(); ++i) by_name[i] = i;
  const auto found =
      order_finder_.find(config_.leg_geometry, R_body_base,
                         unnamed ? std::nullopt : std::optional(by_name), !feet_unnamed_);
  const std::string names =
      joint_names_.empty()
          ? fmt::format("{}: the joints have no names", topics_.joint_states)
          : fmt::format("{}: the names '{}' tell no joints", topics_.joint_states, joint_names_);
  if (!found && unnamed) {
    lack_ = fmt::format("{}, and {}: set recording.joint_names{}", names, found.error().message,
                        joint_names_.empty() ? " to their twelve indices" : "");
    return notes.warn("joints not identified", lack_);
  }
  const std::string feet = fmt::format("{}: no names tell the feet", topics_.contacts);
  if (!found) {
    return notes.warn("order of the feet assumed",
                      fmt::format("{}: FL, FR, RL, RR is assumed (foot_names)", feet));
  }
  if (unnamed) joint_rule_.order = found->joints;
  if (feet_unnamed_) {
    for (const int leg : found->feet) {
      config_.foot_names.emplace_back(kLegNames[static_cast<std::size_t>(leg)]);
    }
  }
  const std::string decided = found->text + ", by the angles and the motion of the legs";
  if (unnamed) {
    notes.warn(
        "order of the joints decided by the data",
        fmt::format("{}: {} (joint_names{})", names, decided, feet_unnamed_ ? ", foot_names" : ""));
  } else {
    notes.warn("order of the feet decided by the data",
               fmt::format("{}: {} (foot_names)", feet, decided));
  }
}

void LegSurvey::add_feet(const MessageView& message, const StateLayout& state) {
  feet_state_ = &state;
  const auto feet = feet_at(message, 0, state);
  if (!feet) return;
  has_feet_ = true;
  for (const Eigen::Vector3d& foot : feet->position) {
    if (foot.allFinite()) farthest_foot_ = std::max(farthest_foot_, foot.norm());
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
  ContactRule rule = {contact_field_, {}, config_.foot_names, contact_state_};
  rule.thresholds.fill({threshold, threshold});
  return rule;
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
    return failure(where + "; set contact_detection: threshold with contact_threshold");
  }
  if (!unknown.empty()) {
    notes.warn("contacts of a foot not learned", where + "; no contact of this foot is used");
  }
  notes.push_back(
      fmt::format("{}: contacts begin/end at '{}' of {} (FL, FR, RL, RR), learned from "
                  "{} messages (contact_detection)",
                  topics_.contacts, contact_field_, list, loads_.size()));
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

Result<ContactRule> LegSurvey::decide_contacts(ReadingNotes& notes) const {
  auto rule = rule_of_loads(notes);
  if (topics_.contacts.empty() || contact_messages_ == 0) return rule;
  const std::string offset = rule ? "" : offset_text(ranges_of_loads());
  if (!offset.empty()) return failure(offset);
  if (!rule) return rule;
  return with_signs(std::move(*rule), notes);
}

Result<ContactRule> LegSurvey::rule_of_loads(ReadingNotes& notes) const {
  ContactRule rule = rule_of(config_.contact_threshold);
  if (topics_.contacts.empty()) return rule;
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

void LegSurvey::note_twist(const std::string& type, const std::string& frame,
                           ReadingNotes& notes) const {
  notes.push_back(fmt::format("{}: a twist without a pose, which is integrated", type));
  if (is_world_frame(frame)) {
    notes.push_back(
        fmt::format("the twist's frame '{}' does not move with the robot: its axes are "
                    "assumed to be the base's",
                    frame));
  }
  if (type == "geometry_msgs/Twist") {
    notes.push_back("geometry_msgs/Twist has no stamp: record times are used");
  }
}

LegSource LegSurvey::decide_feet(ReadingNotes& notes) {
  if (farthest_foot_ > 0.0 && contact_messages_ > 0) {
    notes.push_back(feet_state_->biped == nullptr
                        ? "leg odometry: from feet, contacts and gyro"
                        : fmt::format("leg odometry: from the joints of {}, the torques of its "
                                      "knees and the gyro",
                                      feet_state_->robot));
    return LegSource::kFeet;
  }
  const std::string_view field =
      feet_state_->feet.empty() ? feet_state_->angles : feet_state_->feet;
  const std::string lack = farthest_foot_ > 0.0 ? "no contacts of the feet"
                           : has_feet_          ? fmt::format("{} is zero", field)
                                                : fmt::format("'{}' does not hold all feet", field);
  notes.push_back(fmt::format("{}: {}: estimators run without legs", topics_.leg_odometry, lack));
  if (lack_.empty()) lack_ = lack;
  return LegSource::kNone;
}

LegSource LegSurvey::decide_source(const std::string& type, const std::string& frame,
                                   ReadingNotes& notes) {
  const bool joints = has_joints();
  warn_of_degrees(notes);
  if (joints_assumed_ && joints) {
    notes.warn("order of the joints in a leg assumed",
               fmt::format("{}: the names '{}' tell the legs alone: their joints are taken as "
                           "abduction, hip and knee (joint_names)",
                           topics_.joint_states, joint_names_),
               WarnedSensor::kLegs);
  }
  if (!topics_.joint_states.empty() && joint_messages_ > 0 && !joints && lack_.empty()) {
    lack_ = has_unnamed_joints() && contact_messages_ == 0 ? lack_of_contacts() : lack_of_joints();
    notes.warn("joints not identified", lack_);
  }
  if (!topics_.leg_odometry.empty()) {
    if (type == "nav_msgs/Odometry") return LegSource::kOdometry;
    if (feet_state_ != nullptr) return decide_feet(notes);
    note_twist(type, frame, notes);
    return LegSource::kTwist;
  }
  if (joints && contact_messages_ > 0) {
    notes.push_back(
        "leg odometry: from joints, contacts and gyro by leg kinematics (leg_geometry)");
    return LegSource::kKinematics;
  }
  notes.push_back("no leg odometry, and no joints with contacts: estimators run without legs");
  if (joints && lack_.empty()) lack_ = lack_of_contacts();
  if (joints && effort_messages_ > 0 && topics_.contacts.empty()) {
    notes.push_back(fmt::format("knee torques can indicate contacts: set topics.contacts: {}",
                                topics_.joint_states));
  }
  return LegSource::kNone;
}

}  // namespace aims
