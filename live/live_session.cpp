// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_session.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "core/files/atomic_file.hpp"
#include "core/files/config_dump.hpp"
#include "estimator/estimator_spec.hpp"
#include "live/live_config.hpp"
#include "live/live_estimate.hpp"
#include "live/live_recording.hpp"
#include "live/program.hpp"
#include "live/recorder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

Result<void> check_topics(const LiveConfig& config, const RecordingSetup& setup) {
  if (!requirements_of(config.estimator, config.estimators).legs) return {};
  const auto ok = check_legs(setup, config.estimator, "--set recording.topics.leg_odometry=/...");
  if (ok || !setup.contacts_unknown) return ok;
  // Loads of feet that stand still tell nothing.
  return failure("let the robot walk: " + ok.error().message);
}

/// Whether it spoils the estimate; of an estimator whose needs are not known, all do.
bool concerns(const LiveConfig& config, const ReadingWarning& warning) {
  const Requirements needs = requirements_of(config.estimator, config.estimators);
  if (!needs.lidar && !needs.imu && !needs.legs) return true;
  return warning.concerns(needs.lidar, needs.legs || needs.joints);
}

/// What spoils the estimate, and a calibration of another robot.
std::vector<ReadingWarning> warnings_of(const LiveConfig& config, const RecordingSetup& setup) {
  std::vector<ReadingWarning> warnings = setup.warnings;
  std::erase_if(warnings, [&](const ReadingWarning& each) { return !concerns(config, each); });
  if (!config.calibration) return warnings;
  CalibratedSensors sensors = sensors_of(setup.rig, {});
  sensors.has_lidar = !setup.topics.lidar.empty();
  const auto found = misfits(config.calibration->sensors, sensors);
  if (!found.empty()) {
    warnings.push_back({kOtherRobot, fmt::format("the calibration does not fit this robot: {}",
                                                 fmt::join(found, ", "))});
  }
  return warnings;
}

Result<std::unique_ptr<Estimator>> make_live_estimator(const LiveConfig& config,
                                                       const RecordingSetup& setup) {
  const auto spec = parse_estimator_spec(config.estimator);
  if (!spec) return tl::unexpected(spec.error());
  const auto own = config_with(*spec, config.estimators);
  if (!own) return tl::unexpected(own.error());
  auto made = (*own)->create(setup.rig);
  if (const auto& broken = made->result().failure) return tl::unexpected(*broken);
  return made;
}

/// The estimates of a node, one after the other: each begins as if the program had just started.
class Session {
 public:
  Session(Transport& transport, const LiveOptions& options, LiveConfig config)
      : transport_(transport),
        options_(options),
        config_(std::move(config)),
        commands_(transport),
        publications_(transport, options) {}

  /// Until the node is asked to end.
  Result<void> run() {
    for (int part = 1;; ++part) {
      ClockWatch clocks;
      const auto done = estimate(part, clocks);
      const auto request = commands_.take_restart();
      if (!done || !transport_.running() || (!request && clocks.broken().empty())) {
        if (part > 1) print_missed(transport_.missed(), fmt::format(", in all {} parts", part));
        return done;
      }
      start_anew(request, clocks.broken());
    }
  }

 private:
  fs::path folder_of(int part) const {
    if (part == 1 || options_.out.empty()) return options_.out;
    return fs::path(options_.out) / fmt::format("part-{}", part);
  }

  fs::path record_of(int part) const {
    const fs::path file = options_.record;
    if (part == 1 || file.empty()) return file;
    return file.parent_path() /
           fmt::format("{}-{}{}", file.stem().string(), part, file.extension().string());
  }

  Result<void> estimate(int part, ClockWatch& clocks) {
    const std::string name = label_of(options_.estimator);
    const MissedMessages missed_before = transport_.missed();
    auto log = LiveLog::create(folder_of(part), name);
    if (!log) return tl::unexpected(log.error());
    auto recorder = Recorder::create(record_of(part), transport_.format());
    if (!recorder) return tl::unexpected(recorder.error());
    const LiveRecordingOptions live{
        .live = options_,
        .config = config_.recording,
        .recorder = options_.record.empty() ? nullptr : &*recorder,
        .clocks = &clocks,
        .transforms = &transforms_,
        .check_setup = [&](const RecordingSetup& setup) { return check_topics(config_, setup); },
        .waiting = [&](const std::string& missing) { tell_waiting(missing); }};
    auto opened = open_live_recording(transport_, commands_, live);
    if (!opened || !*opened) {
      const auto recorded = recorder->close();
      print_missed(transport_.missed() - missed_before, "");
      if (opened) return recorded;
      if (!recorded) print_line("warning: " + recorded.error().message);
      return tl::unexpected(opened.error());
    }
    RecordingReader* reader = &**opened;
    const auto warnings = warnings_of(config_, reader->setup());
    for (const std::string& note : reader->setup().notes) print_line("note: " + note);
    for (const ReadingWarning& each : warnings) print_line("warning: " + each.text);
    auto estimator = make_live_estimator(config_, reader->setup());
    if (!estimator) return tl::unexpected(estimator.error());
    if (auto ok = write_config(folder_of(part)); !ok) return ok;
    print_line(
        fmt::format("{} publishes {}", options_.estimator, transport_.resolved("~odometry")));
    LiveEstimate running(transport_, publications_, *reader, **estimator, std::move(*log),
                         {T_odom_start_, &clocks, &*recorder, warnings, part > 1, missed_before,
                          [&](const ReadingWarning& each) { return concerns(config_, each); }});
    commands_.on_save_map([&] { running.save_map(); });
    commands_.on_silence([&](double seconds) { running.tell_silence(seconds); });
    const auto done = running.run();
    commands_.on_save_map({});
    commands_.on_silence({});
    const auto recorded = recorder->close();
    running.print_summary(options_.source_time);
    if (running.last()) last_ = *running.last();
    return done ? recorded : done;
  }

  void tell_waiting(const std::string& missing) {
    print_line("waiting: " + missing);
    publications_.health({wall_time(), HealthState::kStarting, {"waiting: " + missing}, NAN}, {});
  }

  Result<void> write_config(const fs::path& folder) {
    if (folder.empty()) return {};
    return write_file_atomically(folder / "config.yaml", dump_config(fields_of(config_)));
  }

  /// Says why, and decides where the next estimate starts.
  void start_anew(std::optional<LiveRequest> request, const std::string& broken) {
    const bool origin = request == LiveRequest::kReset;
    T_odom_start_ = origin ? std::nullopt : std::optional(level(last_.pose));
    const std::string why = origin ? "reset" : request ? "calibration, standing" : broken;
    print_line(fmt::format("starting anew{}: {}", origin ? "" : " at the last pose", why));
    publications_.health({last_.stamp, HealthState::kInvalid, {"starting anew: " + why}, NAN}, {});
  }

  Transport& transport_;
  const LiveOptions& options_;
  LiveConfig config_;
  Commands commands_;
  Publications publications_;
  LiveTransforms transforms_;
  std::optional<Pose> T_odom_start_;  ///< of the next estimate; none: the origin
  StampedPose last_;
};

}  // namespace

Result<void> run_live(Transport& transport, const LiveOptions& options) {
  auto config = load_live_config(options);
  if (!config) return tl::unexpected(config.error());
  return Session(transport, options, std::move(*config)).run();
}

}  // namespace aims
