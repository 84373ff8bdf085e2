// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/stopwatch.hpp"
#include "estimator/interface/estimator.hpp"
#include "estimator/interface/motion.hpp"
#include "live/clock_watch.hpp"
#include "live/commands.hpp"
#include "live/health_hold.hpp"
#include "live/live_log.hpp"
#include "live/publications.hpp"
#include "live/recorder.hpp"
#include "live/scan_timing.hpp"
#include "recordings/stream/recording_reader.hpp"

namespace aims {

/// How an estimate begins, and who watches it.
struct LiveStart {
  /// Its start in the frame of what is published; none: the origin.
  std::optional<Pose> T_odom_start;
  const ClockWatch* clocks = nullptr;    ///< of its topics
  Recorder* recorder = nullptr;          ///< of its topics
  std::vector<ReadingWarning> warnings;  ///< their reasons are in its health
  bool standing = false;                 ///< the robot should stand: motion is a warning
  MissedMessages missed;                 ///< before it
  /// Whether a warning found later concerns the estimator.
  std::function<bool(const ReadingWarning&)> concerns;
};

/// Prints what was missed; `of`: by which parts.
void print_missed(const MissedMessages& missed, const std::string& of);

/// One estimator on live topics, from its start to its end: it publishes, prints and logs.
class LiveEstimate {
 public:
  LiveEstimate(Transport& transport, Publications& publications, RecordingReader& reader,
               Estimator& estimator, LiveLog log, LiveStart start);

  /// Estimates until the reader ends, then processes what the estimator has queued and completes
  /// the log. Error when the estimator failed, or when the log could not be written, which is a
  /// warning meanwhile.
  Result<void> run();

  /// Writes the map to the log and prints where.
  void save_map();

  /// Publishes and logs that no message has come for so long [s]; prints when that begins.
  void tell_silence(double seconds);

  /// The last pose, as published; none: nothing.
  const std::optional<StampedPose>& last() const { return last_; }

  /// What it missed, of this part alone.
  MissedMessages missed() const { return transport_.missed() - start_.missed; }

  /// Prints what was odd, and how long scans took unless `source_time`.
  void print_summary(bool source_time) const;

 private:
  /// Prints the warning; its reason is in the health from now on.
  void warn(const ReadingWarning& warning);
  /// Publishes and logs that the estimate is invalid so long after its last pose [s].
  void tell_invalid(const char* reason, double seconds);
  void add_silence(std::vector<HealthRow>& rows, bool all);
  void take(const Delivery& delivery);
  void take_rows();
  void warn_of_motion();
  void warn_of_changes();
  void warn_of_file(const Result<void>& state, const char* reason);
  void name_overload(HealthRow& row);
  std::vector<std::string> reasons_of_node();
  void record_doubled(const std::string& topic, const std::string& reason);
  void publish_health(std::vector<HealthRow>& rows);
  void publish(const HealthRow& row);
  void publish_points(Time stamp);
  void save_now_and_then();
  std::vector<Eigen::Vector3f> placed(std::vector<Eigen::Vector3f> points) const;
  std::optional<MotionEstimate> placed_motion(Time until) const;

  Transport& transport_;
  Publications& publications_;
  RecordingReader& reader_;
  Estimator& estimator_;
  const MotionSource* source_;  ///< none: an estimator without
  LiveLog log_;
  LiveStart start_;
  ScanTiming timing_;
  std::optional<StampedPose> last_;
  HealthHold hold_;
  std::optional<HealthRow> printed_;
  Time silent_at_ = std::numeric_limits<Time>::min();  ///< last row of a silence
  std::vector<HealthRow> silence_;                     ///< not yet logged
  bool ended_ = false;                                 ///< the rest is what was queued
  std::string warning_ = "none";                       ///< of the network, the last one
  Time next_map_ = 0;
  std::size_t dropped_ = 0;  ///< messages, at the last row
  std::optional<Stopwatch> since_dropped_;
  std::size_t read_warnings_ = 0;  ///< of the reader, told
  std::set<std::string> doubled_;  ///< topics of several publishers, as recorded
  std::size_t taken_poses_ = 0;
  std::size_t taken_health_ = 0;
  std::size_t poses_ = 0;
  Stopwatch since_summary_;
  Stopwatch since_map_;
};

}  // namespace aims
