// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/measurements.hpp"
#include "recordings/clouds/cloud_survey.hpp"
#include "recordings/frames/recorded_frames.hpp"
#include "recordings/legs/leg_survey.hpp"
#include "recordings/reading_notes.hpp"
#include "recordings/stream/recording_plan.hpp"
#include "recordings/stream/repeated_samples.hpp"
#include "recordings/topics/recording_channels.hpp"

namespace aims {

/// Finds out from the start of a recording how to read it.
class RecordingSurvey {
 public:
  RecordingSurvey(const RecordingConfig& config, const TopicsConfig& topics)
      : config_(config), topics_(topics), legs_(config, topics) {}

  /// Adds the next message of a chosen topic.
  void add(const BagMessage& message, const Channel& channel);
  /// Adds a message of tf; `fixed`: of /tf_static.
  void add_transforms(const MessageView& message, bool fixed) { frames_.add(message, fixed); }

  /// Whether thresholds are learned, for which `add_loads` takes every message of the contacts.
  bool learns_contacts() const { return legs_.learns_contacts(); }
  void add_loads(const MessageView& contacts) { legs_.add_loads(contacts); }

  /// Whether the order of the legs is open, for which `add_motion` takes messages of joints,
  /// contacts and IMU until there are enough.
  bool needs_motion() const { return legs_.needs_order() && !legs_.has_enough_motion(); }
  void add_motion(const BagMessage& message, const Channel& channel);

  /// Whether there are enough messages of that topic.
  bool enough(const std::string& topic) const;

  /// By how much faster record times run than the stamps of all topics, as of a recording that was
  /// played at another speed and recorded again; nothing where they do not differ.
  std::optional<double> record_rate() const;

  /// The earliest record time, without those that were never set.
  Time start(const BagSummary& summary) const;

  /// Decides; appends to `notes`, which become those of the setup. Error when no cloud is
  /// readable, or no contact can be learned.
  Result<RecordingPlan> decide(const std::filesystem::path& bag, std::vector<std::string> notes);

 private:
  /// Stamps and frames of one topic.
  struct Seen {
    std::vector<Time> stamps;
    std::vector<Duration> latencies;  ///< record time minus stamp
    std::vector<Duration> delays;     ///< record time minus when it was taken
    std::vector<bool> is_new;         ///< not the sample before under a new stamp
    std::string frame;
    std::string child_frame;
    std::string type;
    const StateLayout* state = nullptr;  ///< how the type holds a robot's legs, if it does
    bool unstamped = false;              ///< a message has no stamp
  };

  Seen& seen(Role role) { return seen_[static_cast<std::size_t>(role)]; }
  const Seen& seen(Role role) const { return seen_[static_cast<std::size_t>(role)]; }
  void note_times(Role role, const MessageView& view, const BagMessage& message, bool is_new);
  void add_cloud(const MessageView& view, Time record_time);
  void add_imu(const MessageView& view);

  /// A step of the recorder's clock.
  struct ClockStep {
    Time stamp = 0;     ///< of the sensors, at which it was set back
    Duration back = 0;  ///< by so much
  };
  static std::optional<ClockStep> clock_step_of(const Seen& each);
  /// A leap of latencies, which stay before and behind it.
  struct Leap {
    std::size_t at = 0;   ///< message
    Time recorded = 0;    ///< when
    Duration stamps = 0;  ///< by which stamps leap, if record times do not
  };
  static std::optional<Leap> leap_of(const Seen& each);
  bool leaps_alone(Role role, const Leap& leap) const;
  std::optional<Leap> decide_leap(Role role, RecordingPlan& plan);
  Duration burst_of(Role role) const;
  Duration contact_lateness(const RecordingPlan& plan) const;
  static Duration latency_of(const Seen& each, const std::optional<ClockStep>& step);
  static void keep_new(Seen& each);
  static void keep(Seen& each, const std::vector<bool>& kept);
  void leave_out_unset();
  void note_silence(Role role, const std::string& topic);
  void note_record_times(Role role, const std::string& topic);
  void decide_repeats(RecordingPlan& plan);
  void decide_stamps(RecordingPlan& plan);
  /// Of latencies over the stamps seen.
  struct LatencyGrowth {
    Duration growth = 0, span = 0;
    bool even = false;  ///< the same in both halves

    double rate() const {  ///< of record times against stamps
      return 1.0 + static_cast<double>(growth) / static_cast<double>(span);
    }
  };
  static std::optional<LatencyGrowth> growth_of(const Seen& each);
  static std::optional<Duration> latency_without_scan(Role role, const RecordingPlan& plan);
  std::optional<Duration> corrected_latency(Role role, const RecordingPlan& plan) const;
  std::optional<std::array<double, kRoleCount>> corrected_latencies(
      const RecordingPlan& plan) const;
  void decide_waits(RecordingPlan& plan) const;
  void decide_begin(RecordingPlan& plan);
  std::map<Role, Duration> behind(const RecordingPlan& plan, const std::string& reference,
                                  Duration latency) const;
  bool warn_of_imu_clock(const std::map<Role, Duration>& behind, const std::string& reference);
  void warn_of_clocks(const RecordingPlan& plan, const std::string& reference, Duration latency);
  void warn_of_true_clock(const RecordingPlan& plan);
  void warn_of(WarnedSensor sensor, std::size_t first);
  void warn_of_up(const RecordingSetup& setup);
  std::set<std::string> unstamped_states() const;
  double median_norm(Eigen::Vector3d ImuSample::*part) const;
  Eigen::Vector3d force_sum() const;
  bool changes(Eigen::Vector3d ImuSample::*part) const;
  /// Replaces the nominal rate of a sensor by the measured one where they differ by more than 10 %.
  void adopt_rate(std::optional<double> measured_hz, const char* sensor, double& nominal_hz);
  void note_orientation();
  void warn_of_force(double force);
  void decide_force_unit(RecordingPlan& plan);
  std::optional<double> rate_of(Role role, const RecordingPlan& plan) const;
  void warn_of_rate(double rate);
  void warn_of_gyro(const RecordingPlan& plan);
  std::optional<double> force_at_rest(const RecordingPlan& plan) const;
  void warn_of_gravity(const RecordingPlan& plan);
  void warn_of_motion(const RecordingPlan& plan);
  void decide_imu(RecordingPlan& plan);
  void warn_of_odometry(const std::string& type);
  void warn_of_slow_legs(const std::optional<double>& rate);
  void watch_joints_and_contacts(RecordingPlan& plan) const;
  void decide_legs(RecordingPlan& plan);
  bool is_imu_of_base() const;
  void decide_frames(RecordingPlan& plan);
  void decide_truth(RecordingPlan& plan);
  std::string imu_frame() const;
  std::string base_frame() const;

  RecordingConfig config_;
  TopicsConfig topics_;
  std::array<Seen, kRoleCount> seen_;
  std::map<std::string, RepeatFinder> repeats_;  ///< by topic
  CloudSurvey clouds_;
  std::string cloud_error_;               ///< of the first that could not be read
  std::vector<ImuSample> first_samples_;  ///< of the IMU, as recorded
  bool oriented_ = false;                 ///< an IMU message has an orientation
  double largest_turn_rate_ = 0.0;        ///< [rad/s]
  ReadingNotes notes_;
  std::optional<Time> first_set_;  ///< earliest record time of a set clock
  LegSurvey legs_;
  RecordedFrames frames_;
};

}  // namespace aims
