// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_survey.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace aims {
namespace {

constexpr std::size_t kMaxListed = 200;  ///< of names in messages [bytes]
constexpr double kLargeAngle = 6.5;      ///< of no joint of a leg [rad]

}  // namespace

bool is_world_frame(const std::string& frame) {
  return frame.find("odom") != std::string::npos || frame.find("map") != std::string::npos ||
         frame.find("world") != std::string::npos || frame.find("camera_init") != std::string::npos;
}

void LegSurvey::add_joints(const MessageView& message, Time record_time, const StateLayout* state) {
  ++joint_messages_;
  joint_rule_.state = state;
  if (const auto joints = joints_at(message, record_time, joint_rule_)) {
    ++complete_joint_messages_;
    add_rates(*joints);
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

/// Rates that are zero until the joints turn are none.
void LegSurvey::add_rates(const JointReading& joints) {
  const auto is_rate = [](double each) { return each != 0.0; };
  rates_seen_ = rates_seen_ || (joints.velocity && std::ranges::any_of(*joints.velocity, is_rate));
  if (rates_seen_) rate_check_.add(joints);
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
  if (!number_fields_.empty()) {
    return fmt::format("{} has no field '{}': set recording.contacts_field to one of {}",
                       topics_.contacts, contact_field_, number_fields_);
  }
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

LegSource LegSurvey::decide_source(const std::string& type, const std::string& frame,
                                   ReadingNotes& notes) {
  const bool joints = has_joints();
  warn_of_degrees(notes);
  if (auto rates = rate_check_.warning()) notes.warnings.push_back(std::move(*rates));
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
    if (feet_state_ != nullptr) return decide_feet(frame, notes);
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
