// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recordings/clouds/cloud_survey.hpp"
#include "recordings/frames/recorded_frames.hpp"
#include "recordings/legs/leg_stream.hpp"
#include "recordings/stream/recording_plan.hpp"
#include "recordings/topics/recording_channels.hpp"

namespace aims {

/// Learns from the start of a recording how to read the rest.
class RecordingSurvey {
 public:
  RecordingSurvey(const RecordingConfig& config, const TopicsConfig& topics)
      : config_(config), topics_(topics) {}

  /// Takes the next message of a chosen topic.
  void add(const BagMessage& message, const Channel& channel);
  /// Takes a message of tf; `fixed`: of /tf_static.
  void add_transforms(const MessageView& message, bool fixed) { frames_.add(message, fixed); }

  /// Enough of every chosen topic.
  bool enough() const;
  /// At least one message of every chosen topic.
  bool met_all() const;

  /// Decides; appends to `notes`, which become those of the setup. Error when no cloud is readable.
  Result<RecordingPlan> decide(const std::filesystem::path& bag, std::vector<std::string> notes);

 private:
  /// What is seen of one topic.
  struct Seen {
    std::vector<Time> stamps;
    std::vector<Duration> latencies;  ///< record time minus stamp
    std::string frame;
    std::string child_frame;
    std::string type;
  };

  Seen& seen(Role role) { return seen_[static_cast<std::size_t>(role)]; }
  const Seen& seen(Role role) const { return seen_[static_cast<std::size_t>(role)]; }
  void note_times(Role role, const MessageView& view, Time record_time);
  void add_cloud(const MessageView& view, Time record_time);
  void add_imu(const MessageView& view);
  void add_contacts(const MessageView& view, const Channel& channel);
  void choose_contact_field(const Channel& channel);

  void decide_stamps(RecordingPlan& plan) const;
  void decide_imu(RecordingPlan& plan) const;
  void decide_legs(RecordingPlan& plan) const;
  void decide_contacts(RecordingPlan& plan) const;
  void decide_frames(RecordingPlan& plan) const;
  void decide_truth(RecordingPlan& plan) const;
  std::string imu_frame() const;
  std::string base_frame() const;

  RecordingConfig config_;
  TopicsConfig topics_;
  std::array<Seen, kRoleCount> seen_;
  CloudSurvey clouds_;
  std::string cloud_error_;     ///< of the first that could not be read
  std::vector<double> forces_;  ///< magnitudes, as recorded
  double fastest_turn_ = 0.0;
  int joint_messages_ = 0, joint_orders_ = 0, effort_messages_ = 0;
  std::string contact_field_;
  bool contacts_are_flags_ = false;
  int contact_messages_ = 0;
  double largest_load_ = 0.0;
  RecordedFrames frames_;
};

}  // namespace aims
