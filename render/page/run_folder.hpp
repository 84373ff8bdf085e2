// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/scores.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"
#include "core/files/csv_columns.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// A value of the effective configuration that is not the default.
struct ConfigChange {
  std::string key;
  std::string value;
  std::optional<std::string> default_value;  ///< none: an entry of a list that the default lacks
  std::string unit;
};

/// What a folder holds of one estimator; parts that are not there are empty.
struct EstimatorFiles {
  std::string name;
  Trajectory trajectory;  ///< T_odom_body: the valid poses
  std::optional<CsvColumns> diagnostics;
  std::vector<Eigen::Vector3f> map;  ///< in its odometry frame [m], within 1000 km
};

/// What a folder of `aims run`, `aims estimate` or `aims score` holds; parts that are not there are
/// empty or null.
struct RunFolder {
  std::filesystem::path path;
  Json scores;                       ///< scores.json
  Json estimate;                     ///< estimate.json
  std::string config_yaml;           ///< text of config.yaml
  std::optional<Scenario> scenario;  ///< of a simulated run
  ScoreConfig scoring;
  std::vector<ConfigChange> changes;
  Trajectory truth;  ///< T_world_body
  std::vector<WaypointTime> waypoint_times;
  std::optional<CsvColumns> localizability;
  std::optional<CsvColumns> legs;
  std::optional<CsvColumns> scans;
  std::vector<EstimatorFiles> estimators;  ///< as in scores.json, then by name
  std::vector<std::string> notes;          ///< what could not be used, a sentence each
};

/// Whether it holds scores of foreign trajectories (`aims score`): without configuration and seed.
bool is_foreign(const RunFolder& run);

/// Whether the folder holds one run: scores.json, estimate.json or the truth.tum of a run that
/// keeps no scores.
bool holds_run(const std::filesystem::path& folder);

/// Reads a run's folder. A file that is missing leaves its part empty; a configuration that this
/// program does not understand becomes a note. Error, with the file and what was expected, for a
/// file that is broken, and for a folder that holds no run.
Result<RunFolder> read_run_folder(const std::filesystem::path& folder);

}  // namespace aims
