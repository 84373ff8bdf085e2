// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/estimate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "bench/estimate/bag_origin.hpp"
#include "bench/estimate/count_warnings.hpp"
#include "bench/estimate/estimate_log.hpp"
#include "bench/estimate/mount_check.hpp"
#include "bench/estimate/python_classes.hpp"
#include "bench/estimate/ring_note.hpp"
#include "bench/estimate/scoring_input.hpp"
#include "bench/estimate/stream.hpp"
#include "bench/estimate/way_check.hpp"
#include "bench/scoring/score_hints.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/files/pose_cleaning.hpp"
#include "core/files/tum.hpp"
#include "core/files/yaml_config.hpp"
#include "core/stopwatch.hpp"
#include "estimator/estimator_spec.hpp"
#include "recordings/frames/configured_extrinsic.hpp"

namespace aims {
namespace {

/// Nothing that ended before its stream is a success.
void withdraw_successes(EstimateResult& result) {
  for (ScoredEstimate& each : result.scores->estimates) {
    const bool broke = std::ranges::any_of(result.estimators, [&](const EstimatorOutcome& outcome) {
      return outcome.name == each.given.name && outcome.result.failure;
    });
    if (!result.complete || broke) withdraw_success(each.scores, FailureReason::kInterrupted);
  }
}

/// `in_memory` without a folder, else the file in it, with the same poses; none where there is no
/// file.
Result<Trajectory> trajectory_of(const EstimateResult& result, const Trajectory& in_memory,
                                 const std::string& file) {
  if (result.folder.empty()) return in_memory;
  if (!std::filesystem::exists(result.folder / file)) return Trajectory();
  return read_tum(result.folder / file, PoseRules::kAsGiven);
}

/// The kept scans, their motion undone with the truth, else with the first estimate that has poses.
Result<std::vector<ShownScan>> scans_to_show(const EstimateResult& result, const ScanKeeper& kept) {
  auto poses = trajectory_of(result, result.truth, kTruthFile);
  for (const EstimatorOutcome& each : result.estimators) {
    if (!poses || !poses->empty()) break;
    poses = trajectory_of(result, each.result.trajectory, each.name + ".tum");
  }
  if (!poses) return tl::unexpected(poses.error());
  return kept.shown(*poses, result.setup.rig.T_body_lidar);
}

/// What the scores tell of a truth that stopped before the robot did.
void warn_of_frozen_truth(const Result<TrajectoryScores>& scores, RecordingSetup& setup) {
  if (!scores) return;
  std::vector<const Trajectory*> estimates;
  for (const ScoredEstimate& each : scores->estimates) estimates.push_back(&each.given.trajectory);
  const auto hint = frozen_truth_hint(scores->truth.trajectory, estimates);
  if (hint) setup.warnings.push_back({"truth freezes", "truth: " + *hint});
}

/// Scores the trajectories when the recording holds the truth; what keeps it from that is noted.
Result<void> score_against_truth(const EstimateConfig& config, EstimateResult& result) {
  auto truth = trajectory_of(result, result.truth, kTruthFile);
  if (!truth) return tl::unexpected(truth.error());
  if (truth->empty()) return {};
  drop_unusable(*truth, "the truth", result.setup.notes);
  if (const std::string leaps = leaps_text(*truth); !leaps.empty()) {
    result.setup.warnings.push_back({"truth jumps", "truth: " + leaps});
  }
  ScoringInput input;
  input.scoring = config.scoring;
  input.truth = {result.bag.stem().string(), result.bag.string(), "truth of the recording",
                 std::move(*truth)};
  for (const EstimatorOutcome& each : result.estimators) {
    auto estimated = trajectory_of(result, each.result.trajectory, each.name + ".tum");
    if (!estimated) return tl::unexpected(estimated.error());
    input.estimates.push_back({each.name, each.name, "estimated here",
                               with_invalid_poses(std::move(*estimated), each.result)});
  }
  for (const EstimatorOutcome& each : result.estimators) {
    if (!each.result.optimized) continue;
    const std::string label = optimized_label(each.name);
    input.estimates.push_back({label, label, "estimated here", *each.result.optimized});
  }
  if (auto origin = bag_origin(result.bag, result.with)) {
    if (input.scoring.segments.empty()) input.scoring.segments = origin->segments;
    input.segments = segments_wanted(origin->waypoint_times, input.scoring.segments);
    input.waypoint_times = std::move(origin->waypoint_times);
  } else {
    result.setup.notes.push_back(origin.error().message);
  }
  resolve_truth_content(input);
  if (!input.notes.empty()) {
    result.setup.warnings.push_back(
        {"truth of positions alone", fmt::format("{}", fmt::join(input.notes, "; "))});
  }
  auto scores = score_trajectories(std::move(input));
  warn_of_frozen_truth(scores, result.setup);
  if (scores) {
    result.scores = std::move(*scores);
    withdraw_successes(result);
  } else {
    result.setup.notes.push_back("not scored: " + scores.error().message);
  }
  return {};
}

/// Lists those that broke; without any pose there is nothing of them to score.
void set_failed_apart(EstimateResult& result) {
  for (const EstimatorOutcome& each : result.estimators) {
    if (each.result.failure) result.failures.push_back({each.name, each.result.failure->message});
  }
  std::erase_if(result.estimators, [](const EstimatorOutcome& each) {
    return each.result.failure && each.totals.poses == 0;
  });
}

/// A sentence for each part of the clouds, of the IMU and of the legs that an estimator needs and
/// the recording does not hold; where something stands in for it, the notes on the reading state
/// what.
void note_missing(const EstimateConfig& config, RecordingSetup& setup) {
  for (const std::string& text : config.run) {
    const Requirements needs = requirements_of(text, config.estimators);
    const auto note = [&](bool needed, bool present, std::string_view what) {
      if (!needed || present) return;
      setup.notes.push_back(
          fmt::format("{} needs {}, which the recording lacks", label_of(text), what));
    };
    note(needs.point_times, setup.has_point_times, "the time of each point");
    const std::string rings = ring_note(label_of(text), needs, setup.rings, "recording");
    if (!rings.empty()) setup.warnings.push_back({"rings do not fit " + label_of(text), rings});
    note(needs.joints, setup.has_joints, "joints and contacts");
    note(needs.orientation, setup.has_orientation, "the orientation of the IMU");
  }
}

/// Topics that are used, in a fixed order.
std::vector<std::string> topics_of(const TopicsConfig& topics) {
  std::vector<std::string> used = {topics.lidar, topics.imu, topics.leg_odometry,
                                   topics.joint_states, topics.contacts};
  std::erase_if(used, [](const std::string& each) { return each.empty() || each == "none"; });
  return used;
}

/// Warns about a calibration that is of another robot than the recording; notes one without effect.
Result<void> warn_of_misfit(const EstimateOptions& options, RecordingSetup& setup) {
  if (options.calibration.empty()) return {};
  const auto calibration = read_robot_calibration(options.calibration);
  if (!calibration) return tl::unexpected(calibration.error());
  std::vector<std::string> found = misfits(calibration->sensors, calibrated_sensors(setup));
  const bool by_feet = std::ranges::any_of(calibration->quantities, [](const auto& each) {
    return each.used && each.name == "legs_by_feet";
  });
  if (auto idle = nothing_used(*calibration, options.calibration); !idle.empty()) {
    setup.notes.push_back(std::move(idle));
  }
  if (by_feet && !setup.has_joints) found.emplace_back("no joint angles, by which it has the legs");
  if (found.empty()) return {};
  setup.warnings.push_back(
      {kOtherRobot, fmt::format("the calibration {} does not fit this recording: {}",
                                options.calibration.string(), fmt::join(found, ", "))});
  return {};
}

/// The warnings that concern an estimator; all of one whose needs are not known.
std::vector<std::string> reasons_of(const EstimateConfig& config, const RecordingSetup& setup,
                                    const std::string& name) {
  Requirements needs;
  for (const std::string& text : config.run) {
    if (label_of(text) == name) needs = requirements_of(text, config.estimators);
  }
  const bool unknown = !needs.lidar && !needs.imu && !needs.legs;
  std::vector<std::string> reasons;
  for (const ReadingWarning& each : setup.warnings) {
    const bool concerns = each.concerns(needs.lidar, needs.legs || needs.joints);
    if (unknown || concerns) reasons.push_back(each.reason);
  }
  return reasons;
}

/// Adds what the counts of the whole recording say to the warnings, and all of them to the health.
void warn_in_health(const EstimateConfig& config, EstimateResult& result) {
  warn_of_counts(result);
  std::ranges::copy(result.by_lidar, std::back_inserter(result.setup.warnings));
  const std::string too_short = warn_of_length(result);
  for (EstimatorOutcome& each : result.estimators) {
    each.totals.health.too_short = too_short;
    const auto reasons = reasons_of(config, result.setup, each.name);
    if (reasons.empty()) continue;
    HealthSummary& health = each.totals.health;
    if (health.worst == HealthState::kStarting && health.judged) continue;
    health.worst =
        health.judged ? std::max(health.worst, HealthState::kDegraded) : HealthState::kDegraded;
    health.judged = true;
    health.degraded_s += std::exchange(health.healthy_s, 0.0);
    if (health.degraded_s + health.invalid_s == 0.0) health.degraded_s = result.recorded_s;
    for (const std::string& reason : reasons) {
      health.reasons.erase(reason);
      if (std::ranges::find(health.of_recording, reason) != health.of_recording.end()) continue;
      health.of_recording.push_back(reason);
    }
  }
}

/// Adds the reasons that were found on the way to the files of the health; those `known` at the
/// start are in them.
Result<void> add_late_reasons(const EstimateConfig& config, const RecordingSetup& known,
                              const EstimateResult& result) {
  if (result.folder.empty()) return {};
  for (const EstimatorOutcome& each : result.estimators) {
    std::vector<std::string> late = reasons_of(config, result.setup, each.name);
    const auto at_start = reasons_of(config, known, each.name);
    std::erase_if(late, [&](const std::string& reason) {
      return std::ranges::find(at_start, reason) != at_start.end();
    });
    if (auto ok = add_health_reasons(result.folder, each.name, late); !ok) return ok;
  }
  return {};
}

/// Error when an estimator needs legs and the recording has none.
Result<void> check_topics(const EstimateConfig& config, const RecordingSetup& setup,
                          const std::string& recording) {
  for (const std::string& text : config.run) {
    if (!requirements_of(text, config.estimators).legs) continue;
    const auto ok = check_legs(setup, label_of(text), "--topics leg_odometry=/...");
    if (!ok) return failure(fmt::format("{}: {}", recording, ok.error().message));
  }
  return {};
}

/// Streams the recording to its end, or until the observer stops it, and fills in the truth and the
/// estimators. Error when the folder cannot be written.
Result<StreamEnd> stream_into_log(const EstimateConfig& config, RecordingReader& reader,
                                  std::vector<TimedEstimator>& estimators,
                                  const EstimateOptions& options,
                                  const std::function<bool()>& observed, ScanKeeper& scans,
                                  EstimateResult& result) {
  std::vector<std::vector<std::string>> reasons;
  for (const TimedEstimator& each : estimators) {
    reasons.push_back(reasons_of(config, result.setup, each.name()));
  }
  auto log = EstimateLog::create(options.folder, estimators, std::move(reasons));
  if (!log) return tl::unexpected(log.error());
  auto evidence = RotationEvidence::create(result.setup, WatchedScans::kTurns);
  WayCheck way(result.setup);
  const bool in_memory = options.folder.empty();
  Result<void> taken;
  const auto take = [&] {
    if (taken) taken = log->take(estimators);
    if (taken && !in_memory) taken = log->take(reader.take_truth());
    return taken.has_value();
  };
  const auto next_batch = [&](std::vector<Delivery>& batch) {
    auto more = reader.advance(kStreamBatch, batch);
    if (evidence) evidence->consume(batch);
    way.consume(batch);
    for (const Delivery& each : batch) {
      const auto* scan = std::get_if<LidarScanPtr>(&each.measurement);
      if (scan == nullptr) continue;
      scans.add(**scan);
      ++result.clouds;
    }
    return more;
  };
  const StreamEnd end =
      stream(next_batch, estimators, options.jobs, [&] { return take() && observed(); });
  if (take()) taken = log->commit(estimators);
  if (!taken) return tl::unexpected(taken.error());
  if (evidence) evidence->finish();
  // Of clocks that differ each verdict on axes would be one on them.
  const bool clocks = std::ranges::any_of(result.setup.warnings, [](const ReadingWarning& each) {
    return each.kind == WarningKind::kClocks;
  });
  const auto mount =
      evidence && !clocks ? warning_of(*evidence, result.setup.rig.T_body_lidar) : std::nullopt;
  for (const auto& each : {mount, way.warning()}) {
    if (each) result.by_lidar.push_back(*each);
  }
  result.truth = reader.take_truth();
  for (std::size_t i = 0; i < estimators.size(); ++i) {
    const TimedEstimator& each = estimators[i];
    result.estimators.push_back(in_memory ? outcome_of(each) : outcome_without_rows(each));
    result.estimators.back().totals = log->totals(i);
  }
  return end;
}

}  // namespace

CalibratedSensors calibrated_sensors(const RecordingSetup& setup) {
  CalibratedSensors sensors = sensors_of(setup.rig, topics_of(setup.topics));
  sensors.has_lidar = !setup.topics.lidar.empty() && setup.topics.lidar != "none";
  return sensors;
}

void describe(Fields& fields, EstimateConfig& config) {
  fields.texts(
      "run", config.run,
      {.unit = "-", .meaning = "who estimates, by name (`aims list`), or LABEL=NAME+key=value"});
  fields.group("recording", config.recording);
  describe_estimators(fields, config.run, config.estimators);
  fields.group("scoring", config.scoring);
}

Result<EstimateConfig> load_estimate_config(const std::filesystem::path& file,
                                            std::span<const std::string> overrides) {
  EstimateConfig config;
  const YamlFiles files;
  auto chosen_run = choose_run(file, overrides, files, config.run, config.estimators);
  if (!chosen_run) return tl::unexpected(chosen_run.error());
  config.run = std::move(chosen_run->of_file);
  std::vector<AssignedKey> assigned;
  if (!file.empty()) {
    if (auto ok = load_config(file, config, &assigned, files); !ok)
      return tl::unexpected(ok.error());
    find_calibrations(config.recording, file.parent_path());
  }
  config.run = std::move(chosen_run->all);
  if (auto ok = apply_overrides(config, overrides, &assigned, files); !ok) {
    return tl::unexpected(ok.error());
  }
  if (config.run.empty()) return failure("run: expected at least one name");
  if (auto specs = check_estimator_specs(config.run); !specs) {
    return failure("run: " + specs.error().message);
  }
  if (auto right = check_extrinsics(config.recording, assigned); !right) {
    return tl::unexpected(right.error());
  }
  const bool chosen = std::ranges::any_of(overrides, is_run_setting);
  const auto acts =
      check_effects(fields_of(config), std::move(assigned), chosen, config.run, config.estimators);
  if (!acts) return tl::unexpected(acts.error());
  return config;
}

Result<EstimateResult> estimate(const EstimateConfig& config, const EstimateOptions& options,
                                const Observer& observer) {
  const Stopwatch stopwatch;
  auto reader = RecordingReader::open(options.bag, config.recording,
                                      {.recover = options.recover, .with = options.with});
  if (!reader) return tl::unexpected(reader.error());
  EstimateResult result;
  result.bag = options.bag;
  result.with = options.with;
  result.setup = reader->setup();
  const std::size_t at_start = result.setup.warnings.size();
  result.summary = reader->summary();
  if (auto ok = check_topics(config, result.setup, options.bag.string()); !ok)
    return tl::unexpected(ok.error());
  note_missing(config, result.setup);
  if (auto ok = warn_of_misfit(options, result.setup); !ok) return tl::unexpected(ok.error());
  for (const std::string& text : config.run) {
    const bool none = result.setup.rings.count == 0 && !result.setup.topics.lidar.empty();
    if (none && requirements_of(text, config.estimators).rings) {
      result.without_rings.push_back(label_of(text));
    }
  }
  const RecordingSetup known = result.setup;
  auto estimators = make_estimators(config.run, config.estimators, result.setup.rig);
  if (!estimators) return tl::unexpected(estimators.error());

  result.folder = options.folder;
  const double length_s = to_seconds(result.summary.end - result.summary.start);
  const auto observed = [&] {
    return observer({to_seconds(reader->position()), length_s, stopwatch.seconds()});
  };
  ScanKeeper scans(result.summary.end - result.summary.start);
  const auto end = stream_into_log(config, *reader, *estimators, options, observed, scans, result);
  if (!end) return tl::unexpected(end.error());
  result.complete = !end->stopped;
  result.broken = end->error;
  result.counts = reader->counts();
  const auto found = std::span(reader->setup().warnings).subspan(at_start);
  result.setup.warnings.insert(result.setup.warnings.end(), found.begin(), found.end());
  result.recorded_s = to_seconds(reader->position());
  estimators->clear();
  warn_in_health(config, result);
  if (auto ok = add_late_reasons(config, known, result); !ok) return tl::unexpected(ok.error());
  set_failed_apart(result);
  auto shown = scans_to_show(result, scans);
  if (!shown) return tl::unexpected(shown.error());
  result.scans = std::move(*shown);
  if (auto scored = score_against_truth(config, result); !scored) {
    return tl::unexpected(scored.error());
  }
  if (auto added = add_healthy_while_wrong(result); !added) return tl::unexpected(added.error());
  result.wall_s = stopwatch.seconds();
  return result;
}

}  // namespace aims
