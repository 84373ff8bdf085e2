// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/estimate/progress.hpp"
#include "bench/estimate/shown_scans.hpp"
#include "bench/metrics/scores.hpp"
#include "bench/scoring/outcome.hpp"
#include "bench/scoring/trajectory_scoring.hpp"
#include "core/error.hpp"
#include "core/trajectory.hpp"
#include "estimator/registry.hpp"
#include "estimator/robot_calibration.hpp"
#include "recordings/stream/recording_reader.hpp"

namespace aims {

/// How a recording is estimated: its topics, who estimates, and how the result is scored when the
/// recording holds the truth. Scenarios have the same `run`, `estimators` and `scoring`.
struct EstimateConfig {
  std::vector<std::string> run = {"aims_d"};  ///< specs of who estimates
  RecordingConfig recording;
  EstimatorConfigs estimators;
  ScoreConfig scoring;
};

void describe(Fields& fields, EstimateConfig& config);

/// Reads a YAML file (none: the defaults) and applies settings "key=value" on top.
Result<EstimateConfig> load_estimate_config(const std::filesystem::path& file,
                                            std::span<const std::string> overrides);

struct EstimateOptions {
  std::filesystem::path bag;
  bool recover = false;  ///< read the intact part of a broken bag
  int jobs = 1;          ///< threads; the trajectories do not depend on it
  /// Where the truth and what the estimators report by scan are written while the recording is
  /// read; memory then does not grow with them. Empty: the result holds them.
  std::filesystem::path folder = {};
  std::vector<std::filesystem::path> with = {};  ///< further files of the same recording
  std::filesystem::path calibration = {};        ///< of the robot; only to see whether it fits
};

/// An estimator that broke before the end of its stream.
struct EstimatorFailure {
  std::string name;
  std::string message;  ///< of an exception in Python with its traceback, in several lines
};

/// What estimating a recording yields, before it is written.
struct EstimateResult {
  std::filesystem::path bag;
  std::vector<std::filesystem::path> with;  ///< its further files
  RecordingSetup setup;
  BagSummary summary;
  std::map<std::string, int> counts;     ///< of what was odd in the messages
  int clouds = 0;                        ///< of the LiDAR
  std::vector<ReadingWarning> by_lidar;  ///< where LiDAR odometry contradicts gyro or legs
  bool complete = false;                 ///< false when the observer ended it early
  std::optional<Error> broken;  ///< the bag ended in an error; what came before is estimated
  double recorded_s = 0.0;      ///< of the recording that was read
  double wall_s = 0.0;
  /// By estimator: time for which it called itself healthy after its error exceeded the limit of a
  /// success; of those alone that have a truth to err from and did.
  std::map<std::string, double> healthy_while_wrong_s;
  std::vector<EstimatorOutcome> estimators;  ///< their scores are in `scores`
  std::vector<std::string> without_rings;  ///< estimators that need rings, of which there are none
  std::vector<EstimatorFailure> failures;  ///< those with poses are in `estimators` too
  std::filesystem::path folder;            ///< of the options: it has trajectories and truth
  Trajectory truth;                        ///< of the body; empty: none, or in `folder`
  std::vector<ShownScan> scans;            ///< to look at, by the truth or the first estimate
  /// Of the online trajectories, then of the re-optimized ones; none without a truth.
  std::optional<TrajectoryScores> scores;
};

/// What a calibration from that recording holds for.
CalibratedSensors calibrated_sensors(const RecordingSetup& setup);

/// Streams the recording through the estimators. Error when it cannot be opened, a topic is missing
/// or an estimator is unknown.
Result<EstimateResult> estimate(const EstimateConfig& config, const EstimateOptions& options,
                                const Observer& observer);

}  // namespace aims
