// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "recordings/legs/joint_rates.hpp"
#include "recordings/legs/leg_messages.hpp"
#include "recordings/legs/leg_order.hpp"
#include "recordings/legs/leg_stream.hpp"
#include "recordings/legs/load_signs.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/reading_notes.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Whether a frame does not move with the robot, by its name.
bool is_world_frame(const std::string& frame);

/// Finds out from the first messages of a recording how to obtain leg odometry.
class LegSurvey {
 public:
  LegSurvey(const RecordingConfig& config, const TopicsConfig& topics)
      : config_(config),
        topics_(topics),
        joint_rule_{config.joint_names, std::nullopt, nullptr, radians_per(config.joint_unit)} {}

  /// `state`: how the message's type holds a robot's legs, or null. Likewise below.
  void add_joints(const MessageView& message, Time record_time, const StateLayout* state);
  void add_contacts(const MessageView& message, const std::string& type,
                    const MessageDecoder& decoder, const StateLayout* state);

  bool has_joints_and_contacts() const { return has_joints() && contact_messages_ > 0; }

  /// Whether the data must tell which joint or foot is which, from the messages of `add_motion`.
  bool needs_order() const {
    return contact_messages_ > 0 && (has_unnamed_joints() || (has_joints() && feet_unnamed_));
  }
  void add_imu_motion(const Eigen::Vector3d& angular_velocity) {
    order_finder_.add_imu(angular_velocity);
  }
  void add_joint_motion(const MessageView& message, Time record_time);
  void add_load_motion(const MessageView& message);
  bool has_enough_motion() const { return order_finder_.full(); }
  /// Decides the order of joints and feet where the names do not tell; before all other decisions.
  void decide_order(const Eigen::Quaterniond& R_body_base, ReadingNotes& notes);

  const JointRule& joint_rule() const { return joint_rule_; }
  /// Why there is no leg odometry, as far as it is known.
  const std::string& lack() const { return lack_; }
  /// Whether there is none since no contacts can be learned from the loads, as before the first
  /// steps.
  bool contacts_unknown() const { return contacts_unknown_; }

  /// Adds the feet of a topic of leg odometry that has them.
  void add_feet(const MessageView& message, const StateLayout& state);

  /// Whether the thresholds of contacts are to be learned, from the loads of `add_loads`.
  bool learns_contacts() const;
  /// Adds the loads of a message of the contacts.
  void add_loads(const MessageView& message);

  /// How contacts are read; appends assumptions to `notes`, as all below. Error for loads from
  /// which no thresholds can be learned.
  Result<ContactRule> decide_contacts(ReadingNotes& notes);

  /// Whether contacts are published only when they change: then the last ones hold, with a warning.
  bool contacts_hold(ReadingNotes& notes) const;

  /// Goes on without the contacts, which cannot be used for that reason.
  ContactRule without_contacts(const std::string& reason, ReadingNotes& notes);

  /// The source of leg odometry. `type` and `frame` are those of the leg odometry topic, if any.
  LegSource decide_source(const std::string& type, const std::string& frame, ReadingNotes& notes);

 private:
  bool has_joints() const { return complete_joint_messages_ > 0 || joint_rule_.order; }
  bool has_unnamed_joints() const {
    return complete_joint_messages_ == 0 && unnamed_joint_messages_ > 0;
  }
  void add_angles(const MessageView& message, Time record_time);
  void add_rates(const JointReading& joints);
  void warn_of_degrees(ReadingNotes& notes) const;
  std::string lack_of_joints() const;
  std::string lack_of_contacts() const;
  std::string advice_on_contacts() const;
  ContactRule rule_of(double threshold) const;
  Result<ContactRule> learned_rule(ReadingNotes& notes) const;
  bool loads_are_torques() const;
  std::array<LoadRange, kLegCount> ranges_of_loads() const;
  std::string offset_text(const std::array<LoadRange, kLegCount>& ranges) const;
  Result<ContactRule> rule_of_loads(ReadingNotes& notes) const;
  Result<ContactRule> with_signs(ContactRule rule, ReadingNotes& notes) const;
  void choose_contact_field(const std::string& type, const MessageDecoder& decoder,
                            const StateLayout* state);
  LegSource decide_feet(const std::string& frame, ReadingNotes& notes);
  std::string lack_of_feet(const std::string& frame) const;
  void warn_of_feet(ReadingNotes& notes) const;
  void note_twist(const std::string& type, const std::string& frame, ReadingNotes& notes) const;

  RecordingConfig config_;
  TopicsConfig topics_;
  int joint_messages_ = 0;
  int complete_joint_messages_ = 0;  ///< with all twelve joints
  int unnamed_joint_messages_ = 0;
  int large_angles_ = 0;  ///< messages with an angle that no joint has in rad
  JointRateCheck rate_check_;
  bool rates_seen_ = false;
  std::string joint_names_;         ///< recorded, of the first message
  bool joints_of_one_leg_ = false;  ///< of the first message, by their names
  bool joints_assumed_ = false;     ///< the names tell the legs alone
  JointRule joint_rule_;
  LegOrderFinder order_finder_;
  bool feet_unnamed_ = false;
  std::string lack_;
  bool contacts_unknown_ = false;
  int effort_messages_ = 0;
  int contact_messages_ = 0;
  int repeated_contacts_ = 0;  ///< messages whose contacts are those of the one before
  int foot_messages_ = 0;      ///< of feet without joints
  std::string contact_field_;
  bool contacts_are_flags_ = false;
  bool contacts_are_raw_ = false;               ///< counts without calibration, or torques
  const StateLayout* contact_state_ = nullptr;  ///< if its contacts are read
  const StateLayout* contact_knees_ = nullptr;  ///< if numbers of its joints are
  std::string torque_field_;                    ///< of a robot's state with contacts; empty: none
  const StateLayout* feet_state_ = nullptr;     ///< of the feet without joints
  double largest_load_ = 0.0;
  bool has_feet_ = false;
  double farthest_foot_ = 0.0;  ///< of the feet without joints [m]
  std::array<Eigen::Vector3d, kLegCount> sum_of_feet_ = {
      Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
      Eigen::Vector3d::Zero()};          ///< of their places
  std::string number_fields_;            ///< of the contacts, where they lack the configured one
  std::vector<FootLoads> first_loads_;   ///< of the survey
  std::vector<FootLoads> first_forces_;  ///< likewise, beside flags of contact
  std::vector<FootLoads> loads_;         ///< of the whole recording, where thresholds are learned
};

}  // namespace aims
