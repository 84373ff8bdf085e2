// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "recordings/legs/leg_messages.hpp"
#include "recordings/legs/leg_stream.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Whether a frame does not move with the robot, by its name.
bool is_world_frame(const std::string& frame);

/// Finds out from the first messages of a recording how to obtain leg odometry.
class LegSurvey {
 public:
  LegSurvey(const RecordingConfig& config, const TopicsConfig& topics)
      : config_(config), topics_(topics) {}

  void add_joints(const MessageView& message, Time record_time);
  void add_contacts(const MessageView& message, const std::string& type,
                    const MessageDecoder& decoder);

  bool has_joints_and_contacts() const {
    return complete_joint_messages_ > 0 && contact_messages_ > 0;
  }

  /// Adds the feet of a topic of leg odometry that has them.
  void add_feet(const MessageView& message);

  /// Whether the thresholds of contacts are to be learned, from the loads of `add_loads`.
  bool learns_contacts() const;
  /// Adds the loads of a message of the contacts.
  void add_loads(const MessageView& message);

  /// How contacts are read; appends assumptions to `notes`, as all below. Error for loads from
  /// which no thresholds can be learned.
  Result<ContactRule> decide_contacts(std::vector<std::string>& notes) const;

  /// The source of leg odometry. `type` and `frame` are those of the leg odometry topic, if any.
  LegSource decide_source(const std::string& type, const std::string& frame,
                          std::vector<std::string>& notes) const;

 private:
  ContactRule rule_of(double threshold) const;
  Result<ContactRule> learned_rule(std::vector<std::string>& notes) const;
  void choose_contact_field(const std::string& type, const MessageDecoder& decoder);
  LegSource decide_feet(std::vector<std::string>& notes) const;
  void note_twist(const std::string& type, const std::string& frame,
                  std::vector<std::string>& notes) const;

  RecordingConfig config_;
  TopicsConfig topics_;
  int joint_messages_ = 0;
  int complete_joint_messages_ = 0;  ///< with all twelve joints
  int effort_messages_ = 0;
  int contact_messages_ = 0;
  std::string contact_field_;
  bool contacts_are_flags_ = false;
  bool contacts_are_raw_ = false;  ///< counts without calibration
  double largest_load_ = 0.0;
  double farthest_foot_ = 0.0;  ///< of the feet without joints [m]
  std::vector<FootLoads> loads_;
};

}  // namespace aims
