// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "recordings/clouds/repeated_clouds.hpp"
#include "recordings/event_counts.hpp"
#include "recordings/legs/leg_stream.hpp"
#include "recordings/stream/missing_messages.hpp"
#include "recordings/stream/recording_plan.hpp"
#include "recordings/stream/repeated_samples.hpp"

namespace aims {

/// When a message was recorded and taken.
struct MessageTimes {
  Time recorded = 0;                         ///< as corrected, where the recorder's clock leapt
  std::optional<Time> sampled;               ///< where its record time is that of a batch
  std::optional<Duration> leapt;             ///< by which its stamp is wrong
  Duration position = 0;                     ///< since the start of the recording
  std::optional<Time> usual = std::nullopt;  ///< when it would have been recorded, if it was late

  Time taken() const { return sampled.value_or(recorded); }  ///< in place of a stamp
};

/// Makes deliveries of messages, in order of arrival, as the plan of the recording says.
class DeliveryMaker {
 public:
  DeliveryMaker(RecordingPlan decided, const RecordingConfig& config);

  /// Appends what the message becomes, or completes.
  void take(const Channel& channel, const MessageView& view, const MessageTimes& times,
            std::vector<Delivery>& out);
  /// Counts a message that contradicts its definition.
  void malformed(Role role, Time recorded, Time arrived);
  /// Counts a message of which nothing is read as one that came.
  void leave_out(const Channel& channel, Time recorded);
  /// Warns of what the whole recording tells.
  void finish();

  RecordingPlan plan;  ///< to whose warnings is added what changes midway
  EventCounts counts;  ///< of irregularities
  Trajectory truth;

 private:
  bool is_repeated(const Channel& channel, const MessageView& view);
  void note_frame(Role role, const MessageView& view);
  void watch_frame(const MessageView& view);
  void watch_repeats(const PointTable& table);
  std::optional<LidarScan> read_scan(const PointTable& table);
  void take_cloud(const MessageView& view, std::vector<Delivery>& out);
  void take_imu(const MessageView& view, std::vector<Delivery>& out);
  void take_legs(const Channel& channel, const MessageView& view, std::vector<Delivery>& out);
  void take_feet(const Channel& channel, const MessageView& view, std::vector<Delivery>& out);
  void take_joints(const MessageView& view, std::vector<Delivery>& out);
  void take_contacts(const MessageView& view, std::vector<Delivery>& out);
  void take_truth(const MessageView& view);
  void deliver(Role role, Measurement measurement, Time stamp, std::vector<Delivery>& out);
  void deliver(std::optional<LegOdometrySample> sample, std::vector<Delivery>& out);
  Time stamp_of(Role role, Time stamp, double delay) const;
  Duration period_of(Role role) const;
  int legs_left_out() const;
  bool legs_by_joints() const { return plan.setup.topics.leg_odometry.empty(); }
  Time heard_at() const;
  Time arrived_at() const;
  MissingMessages& missing(Role role) { return missing_[static_cast<std::size_t>(role)]; }
  Role source_of(Role role) const;
  void warn_of_missing(Role role);
  void warn_of_absence(Role role, Time begin, Time end);

  RecordingConfig config_;
  MessageTimes now_;  ///< of the current message
  TurnJoiner turns_;  ///< of clouds that are parts of scans
  RepeatedClouds repeated_clouds_;
  LegStream legs_;
  ContactDetector contact_detector_;
  std::map<std::string, RepeatFilter> repeats_;  ///< by topic
  std::array<std::optional<Time>, kRoleCount> last_stamps_;
  std::array<std::string, kRoleCount> frames_;  ///< of the first messages
  std::array<MissingMessages, kRoleCount> missing_;
  int left_out_ = 0;  ///< samples of legs, as counted in `missing_`
  std::optional<Time> last_true_stamp_;
};

}  // namespace aims
