// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/metrics/scores.hpp"
#include "bench/scenario/scenario_draws.hpp"
#include "core/config.hpp"
#include "core/error.hpp"
#include "estimator/registry.hpp"
#include "sim/sensors/sensor_level.hpp"
#include "sim/simulation_config.hpp"

namespace aims {

/// What of a score over several seeds is held against the limits.
enum class ExpectationStatistic {
  kWorst,   ///< the largest against `max`, the smallest against `min`
  kMedian,  ///< the middle
  kMean,    ///< of `success`: the fraction of seeds
};

/// A limit that is none: the end of the range of limits, so that what is written is read again.
inline constexpr double kNoLimit = 1e12;

/// Limits that a score must hold over the seeds of an invocation, or it fails (exit code 1). `min`
/// serves scores of which more is better, and errors that must not become small unnoticed.
struct Expectation {
  /// Name in the registry, or a label of the scenario's estimators; empty: of the run itself.
  std::string estimator;
  /// Dotted key inside the estimator's scores, e.g. "m_list_percent.a-b"; of the run "robot.fell".
  std::string score;
  double max = kNoLimit;   ///< in the score's own unit
  double min = -kNoLimit;  ///< in the score's own unit
  ExpectationStatistic statistic = ExpectationStatistic::kWorst;
  /// Level of the sensors at which it is held: "ideal", "datasheet", "field"; empty: at each.
  std::string sensors = {};

  bool operator==(const Expectation&) const = default;
};

/// One experiment: the world, the route, the sensors, the estimators, and the expectations.
struct Scenario {
  std::filesystem::path file;          ///< where it was read from, for messages; empty: nowhere
  std::filesystem::path folder;        ///< where bare names of `base` are looked up; may be empty
  std::vector<std::string> overrides;  ///< "key=value" that were applied on top of the file
  std::string name;
  std::string description;
  std::vector<std::string> tags;
  std::string family;      ///< scenarios that differ in one quantity, e.g. "leg_loss"; empty: none
  double level = 0.0;      ///< that quantity, in `level_unit`; scores of a family are drawn over it
  std::string level_unit;  ///< e.g. "m", "%"
  int seed = 1;
  /// Specs (estimator/estimator_spec.hpp) of who runs.
  std::vector<std::string> run = {"aims", "aims_d", "tfs", "tfs_clean", "tfs_plus", "lio", "leg"};
  /// Chooses the presets below the scenario's own keys. A scenario that is read has `kField` unless
  /// it names another.
  SensorLevel sensors = SensorLevel::kIdeal;
  ImuGrade imu_grade = ImuGrade::kOfLevel;  ///< replaces the level's figures of the IMU
  SimulationConfig simulation;
  std::vector<Draw> draw;         ///< what each seed draws anew; see `scenario_of_seed`
  std::vector<DrawnValue> drawn;  ///< on a seed, once drawn
  EstimatorConfigs estimators;
  ScoreConfig scoring;
  std::vector<Expectation> expect;
};

void describe(Fields& fields, Expectation& expectation);
void describe(Fields& fields, Scenario& scenario);

/// `error`, whose message begins with a key of the scenario, with the key's file, line and column.
Error located(const Scenario& scenario, const Error& error);

/// Error, with the line in the scenario's file, when the route cannot be walked on that seed; see
/// `check_walk`.
Result<void> check_simulation(const Scenario& scenario, std::uint64_t seed);

/// Of a scene whose length an override changes while the route stays: the robot turns or ends where
/// it did before.
std::optional<std::string> route_warning(const Scenario& scenario);

/// What was set on top of the file, but who runs.
std::vector<std::string> settings_of(const Scenario& scenario);

/// The line that states them at the head of a summary.
std::string settings_markdown(const std::vector<std::string>& settings);

/// Reads a scenario and applies `overrides` ("key=value") on top of it. Checks everything that can
/// be checked without simulating; errors are one line that names file, line, key and expectation.
/// `folder` is where a bare name of `base` is looked up that is not beside the file.
Result<Scenario> load_scenario(const std::filesystem::path& file,
                               std::span<const std::string> overrides,
                               const std::filesystem::path& folder = {});

/// The scenario that an empty file describes, with `overrides` on top.
Result<Scenario> default_scenario(std::span<const std::string> overrides);

/// Every parameter of the scenario that has an effect, as YAML that loads again; `annotated` adds
/// unit, range, meaning and source to each.
std::string config_text(const Scenario& scenario, bool annotated = false);

/// The configuration that repeats a run with that seed, with what the seed draws. Its description
/// names what was set on top of the file.
std::string effective_config(const Scenario& scenario, std::uint64_t seed);

/// The file of a scenario given by path or by bare name ("corridor"), searched in `folder` and
/// below.
Result<std::filesystem::path> find_scenario(const std::string& given,
                                            const std::filesystem::path& folder);

/// Every scenario file in `folder` and below, in order of their paths. Error when two have the same
/// bare name.
Result<std::vector<std::filesystem::path>> scenario_files(const std::filesystem::path& folder);

/// How to score, by the group `scoring` of a YAML file (none: the defaults) with the settings
/// "scoring.key=value" on top. Any scenario, or the config.yaml of a run, may be given: the rest of
/// it is checked and left.
Result<ScoreConfig> scoring_config(const std::filesystem::path& file,
                                   std::span<const std::string> overrides);

/// The description in the configuration of a run, without what was set on top, which it names.
std::string description_without_settings(const std::string& description);

}  // namespace aims
