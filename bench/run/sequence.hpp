// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "bench/run/run_localizability.hpp"
#include "bench/run/sequence_file.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/scenario/sequence_record.hpp"
#include "core/error.hpp"
#include "core/trajectory.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// Poses of the truth are written at this spacing; the simulation holds them at the physics rate.
inline constexpr Duration kTruthSpacing = 10 * kMillisecond;

/// A simulated sequence, open for any number of estimators, with what all their scores need.
struct Sequence {
  SequenceReader reader;        ///< the measurements stay in the file
  Trajectory truth_trajectory;  ///< T_world_body at the physics rate
  std::vector<WaypointTime> waypoint_times;
  RunLocalizability localizability;
  WalkOutcome walk;

  Time end() const { return truth_trajectory.empty() ? 0 : truth_trajectory.back().stamp; }
};

/// Opens the file of the scenario's sequence on that seed (bench/jobs/sequence_cache.hpp).
Result<Sequence> open_sequence(const std::filesystem::path& file, const Scenario& scenario,
                               std::uint64_t seed);

/// Writes what is known of the sequence whoever estimates: truth.tum, waypoint_times.csv,
/// localizability.csv, legs.csv, and for pictures snapshots.csv (the robot's joints at 10 Hz) and
/// scans.csv (bench/estimate/shown_scans.hpp).
Result<void> write_sequence(const Sequence& sequence, const Scenario& scenario,
                            const std::filesystem::path& folder);

/// What scores.json holds of the run whoever estimates; `scores` are of any estimator.
Json sequence_json(const Sequence& sequence, const Scenario& scenario, const Scores& scores);

/// Names of the files that `write_sequence` writes.
inline constexpr const char* kSequenceFiles[] = {"truth.tum",          "waypoint_times.csv",
                                                 "localizability.csv", "legs.csv",
                                                 "snapshots.csv",      "scans.csv"};

/// What a run's folder holds of its scenario and way.
struct WrittenSequence {
  Scenario scenario;
  std::uint64_t seed = 0;
  Scene scene;
  Trajectory truth;
  std::vector<WaypointTime> waypoint_times;
};

/// Reads config.yaml, truth.tum and waypoint_times.csv.
Result<WrittenSequence> read_sequence(const std::filesystem::path& folder);

/// Reads snapshots.csv.
Result<std::vector<RobotSnapshot>> read_snapshots(const std::filesystem::path& file);

}  // namespace aims
