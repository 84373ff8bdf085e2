// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "estimator/estimator_spec.hpp"
#include "live/live_config.hpp"
#include "live/live_log.hpp"
#include "live/live_recording.hpp"
#include "live/publications.hpp"
#include "live/recorder.hpp"

namespace aims {
namespace {

/// Record time of one batch of deliveries.
constexpr Duration kBatch = 5 * kMillisecond;
constexpr Duration kMapPeriod = 5 * kSecond;
/// In which the estimator catches up with what was gathered before it started.
constexpr Duration kCatchUp = 2 * kSecond;

Time wall_time() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

/// The part of an estimator's rows that is new since the last call.
class NewRows {
 public:
  explicit NewRows(Estimator& estimator) : estimator_(estimator) {}

  std::span<const StampedPose> poses() const {
    return std::span(estimator_.result().trajectory).subspan(poses_);
  }
  std::span<const HealthRow> health() const {
    return std::span(estimator_.result().health).subspan(health_);
  }

  /// All rows are taken; the estimator forgets them, so that memory does not grow.
  void taken() {
    estimator_.forget_rows();
    poses_ = estimator_.result().trajectory.size();
    health_ = estimator_.result().health.size();
  }

 private:
  Estimator& estimator_;
  std::size_t poses_ = 0;
  std::size_t health_ = 0;
};

/// Prints state and reasons where they change.
class HealthPrinter {
 public:
  void print(std::span<const HealthRow> rows) {
    for (const HealthRow& row : rows) {
      if (last_ && row.state == last_->state && row.reasons == last_->reasons) continue;
      print_line(fmt::format("health at {:.1f} s: {}{}{}", to_seconds(row.stamp),
                             name_of(row.state), row.reasons.empty() ? "" : ": ",
                             fmt::join(row.reasons, "; ")));
      last_ = row;
    }
  }

 private:
  std::optional<HealthRow> last_;
};

/// From the arrival of a scan to its odometry, without those that waited for the start.
class Latency {
 public:
  void arrived(const Delivery& delivery, Time arrival) {
    const auto* scan = std::get_if<LidarScanPtr>(&delivery.measurement);
    if (scan != nullptr && arrival >= first_) {
      waiting_.emplace_back((*scan)->end, arrival);
    }
  }

  void published(Time stamp) {
    while (!waiting_.empty() && waiting_.front().first < stamp) waiting_.pop_front();
    if (waiting_.empty() || waiting_.front().first != stamp) return;
    const Duration taken = wall_time() - waiting_.front().second;
    ++counts_[static_cast<std::size_t>(
        std::clamp<Duration>(taken / kMillisecond, 0, counts_.size() - 1))];
    ++total_;
  }

  /// [ms], rounded down; of more than a second: a second.
  std::size_t quantile(double part) const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      sum += counts_[i];
      if (static_cast<double>(sum) >= part * static_cast<double>(total_)) return i;
    }
    return counts_.size();
  }

  bool empty() const { return total_ == 0; }

 private:
  Time first_ = wall_time() + kCatchUp;
  std::deque<std::pair<Time, Time>> waiting_;  ///< end and arrival of scans
  std::array<std::size_t, 1001> counts_{};     ///< by whole milliseconds
  std::size_t total_ = 0;
};

/// Estimates and publishes.
class Session {
 public:
  Session(Transport& transport, RecordingReader& reader, Estimator& estimator,
          Publications publications, LiveLog log)
      : transport_(transport),
        reader_(reader),
        estimator_(estimator),
        source_(dynamic_cast<const MotionSource*>(&estimator)),
        rows_(estimator),
        publications_(std::move(publications)),
        log_(std::move(log)) {}

  /// Estimates until the node is asked to end, then processes what the estimator has queued.
  Result<void> run() {
    std::vector<Delivery> deliveries;
    bool more = true;
    while (more) {
      const auto advanced = reader_.advance(kBatch, deliveries);
      if (!advanced) return tl::unexpected(advanced.error());
      more = *advanced;
      for (const Delivery& delivery : deliveries) {
        if (auto ok = take(delivery); !ok) return ok;
      }
      deliveries.clear();
      for (const std::string& problem : transport_.take_problems()) {
        print_line("warning: " + problem);
      }
    }
    estimator_.finish();
    return take_rows();
  }

  std::size_t poses() const { return poses_; }
  const Latency& latency() const { return latency_; }

 private:
  Result<void> take(const Delivery& delivery) {
    // The deliveries of a batch arrived within 5 ms; their own arrivals are on the stamps' clock.
    latency_.arrived(delivery, reader_.summary().start + reader_.position());
    estimator_.consume(delivery);
    const bool inertial = std::holds_alternative<ImuSample>(delivery.measurement);
    if (inertial && source_ != nullptr && publications_.fast_heard()) {
      if (const auto motion = source_->motion(std::numeric_limits<Time>::max())) {
        publications_.fast(*motion);
      }
    }
    return take_rows();
  }

  Result<void> take_rows() {
    const auto poses = rows_.poses();
    const auto health = rows_.health();
    if (poses.empty() && health.empty()) return {};
    for (const StampedPose& pose : poses) {
      publications_.pose(pose, source_ != nullptr ? source_->motion(pose.stamp) : std::nullopt);
      latency_.published(pose.stamp);
    }
    if (!poses.empty()) publish_points(poses.back().stamp);
    health_.print(health);
    for (const HealthRow& row : health) {
      publications_.health(row, transport_.dropped(), transport_.lost());
    }
    poses_ += poses.size();
    if (auto ok = log_.add(poses, health); !ok) return ok;
    rows_.taken();
    return {};
  }

  void publish_points(Time stamp) {
    if (source_ != nullptr && publications_.cloud_heard()) {
      publications_.cloud(stamp, source_->registered_points());
    }
    if (stamp < next_map_ || !publications_.map_heard()) return;
    publications_.map(stamp, estimator_.map_points());
    next_map_ = stamp + kMapPeriod;
  }

  Transport& transport_;
  RecordingReader& reader_;
  Estimator& estimator_;
  const MotionSource* source_;  ///< none: an estimator without
  NewRows rows_;
  Publications publications_;
  LiveLog log_;
  HealthPrinter health_;
  Latency latency_;
  Time next_map_ = 0;
  std::size_t poses_ = 0;
};

void print_summary(const RecordingReader& reader, const Estimator& estimator,
                   const Session& session, const Transport& transport) {
  for (const auto& [event, count] : reader.counts())
    print_line(fmt::format("note: {}: {}", event, count));
  for (const auto& [event, count] : estimator.result().counts) {
    print_line(fmt::format("note: {}: {}", event, count));
  }
  const std::size_t dropped = transport.dropped();
  if (dropped > 0)
    print_line(fmt::format("note: {} messages dropped, since the node was too slow", dropped));
  const std::size_t lost = transport.lost();
  if (lost > 0) print_line(fmt::format("note: {} messages lost by the network", lost));
  print_line(fmt::format("{} poses", session.poses()));
}

void print_latency(const Latency& latency) {
  if (latency.empty()) return;
  print_line(fmt::format("from the arrival of a scan to its odometry: median {} ms, 99 % {} ms",
                         latency.quantile(0.5), latency.quantile(0.99)));
}

Result<void> check_topics(const LiveConfig& config, const RecordingSetup& setup) {
  if (!requirements_of(config.estimator, config.estimators).legs) return {};
  return check_legs(setup, config.estimator, "live topics");
}

/// The estimator; prints what was assumed about the network.
Result<std::unique_ptr<Estimator>> make_live_estimator(const LiveConfig& config,
                                                       const RecordingSetup& setup) {
  for (const std::string& note : setup.notes) print_line("note: " + note);
  for (const ReadingWarning& each : setup.warnings) print_line("warning: " + each.text);
  const auto spec = parse_estimator_spec(config.estimator);
  if (!spec) return tl::unexpected(spec.error());
  const auto own = config_with(*spec, config.estimators);
  if (!own) return tl::unexpected(own.error());
  return (*own)->create(setup.rig);
}

Result<void> estimate_live(Transport& transport, const LiveOptions& options) {
  const auto config = load_live_config(options);
  if (!config) return tl::unexpected(config.error());
  auto log = LiveLog::create(options.out, label_of(options.estimator));
  if (!log) return tl::unexpected(log.error());
  auto recorder = Recorder::create(options.record, transport.cdr());
  if (!recorder) return tl::unexpected(recorder.error());
  LiveRecordingOptions live{.settle = from_seconds(options.settle),
                            .patience = options.patience,
                            .max_wait = from_seconds(options.max_wait),
                            .observer = {}};
  if (!options.record.empty()) {
    live.observer = [&](const BagMessage& message) { recorder->add(message); };
  }
  auto reader = open_live_recording(
      transport, config->recording, live,
      [&](const RecordingSetup& setup) { return check_topics(*config, setup); },
      [](const std::string& missing) { print_line("waiting: " + missing); });
  if (!reader) return tl::unexpected(reader.error());
  auto estimator = make_live_estimator(*config, reader->setup());
  if (!estimator) return tl::unexpected(estimator.error());
  Publications publications(transport, {options.odom_frame, options.body_frame, options.tf},
                            label_of(options.estimator));
  print_line(fmt::format("{} publishes {}", options.estimator, transport.resolved("~odometry")));
  Session session(transport, *reader, **estimator, std::move(publications), std::move(*log));
  const auto done = session.run();
  const auto recorded = recorder->close();
  print_summary(*reader, **estimator, session, transport);
  if (!options.source_time) print_latency(session.latency());
  return done ? recorded : done;
}

}  // namespace

void print_line(const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

int report_bad_input(const std::string& program, const Error& error) {
  fmt::print(stderr, "{}: {}\n", program, error.message);
  return kLiveBadInput;
}

int run_live(Transport& transport, const LiveOptions& options, const std::string& program) {
  const auto done = estimate_live(transport, options);
  return done ? kLiveOk : report_bad_input(program, done.error());
}

}  // namespace aims
