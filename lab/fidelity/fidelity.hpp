// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"
#include "core/leg_kinematics.hpp"
#include "lab/fidelity/imu_statistics.hpp"
#include "lab/fidelity/range_residuals.hpp"
#include "lab/fidelity/stance_profile.hpp"

namespace aims {

/// Allan deviation of the standing IMU, root mean square over the axes.
struct StandingDeviation {
  double tau = 0.0;            ///< averaging time [s]
  double gyro = 0.0;           ///< [rad/s]
  double accelerometer = 0.0;  ///< [m/s^2]
};

/// What the leg odometry reads on one segment of the route.
struct LegDrift {
  FootModel foot_model = FootModel::kPoint;
  double contact_on = 0.0;  ///< foot load above which contact is detected [N]
  std::string segment;
  double signed_percent = 0.0;  ///< of the straight distance; < 0: reads short
  double heading_deg = 0.0;     ///< change of the heading's error
};

/// The sensors of a scenario, held against references.
struct Fidelity {
  std::string scenario;
  std::uint64_t seed = 1;
  std::vector<ImuStatistic> trot;
  std::vector<ImuStatistic> standing;
  std::vector<StandingDeviation> allan;
  std::vector<ResidualBin> ranges;
  std::vector<LegDrift> legs;
  std::vector<StanceBin> stance;
};

/// Receives what is being done, after each simulated second; returns false to stop the study.
using FidelityObserver = std::function<bool(std::string_view step)>;

/// Profile of the scenario's walk to its second waypoint, whose gait is to be that of the real
/// robot of the profile. Errors as those of `fidelity_study`.
Result<std::vector<StanceBin>> stance_study(const Scenario& walk_of_go1, std::uint64_t seed,
                                            const FidelityObserver& observer);

/// Simulates the scenario's route with its sensors on perfect links, once for IMU and LiDAR, once
/// standing for `standing_time` [s], and once per foot model and contact threshold of the leg
/// odometry; the stance profile is that of `walk_of_go1`. Error for a simulation that cannot start
/// or that falls, and for a study that the observer stopped.
Result<Fidelity> fidelity_study(const Scenario& scenario, const Scenario& walk_of_go1,
                                std::uint64_t seed, double standing_time,
                                const FidelityObserver& observer);

TextTable allan_table(const std::vector<StandingDeviation>& allan);
TextTable range_table(const std::vector<ResidualBin>& bins);
TextTable leg_drift_table(const std::vector<LegDrift>& legs);

/// Writes fidelity.md and the CSV tables imu.csv, allan.csv, ranges.csv, leg_drift.csv,
/// stance.csv.
Result<void> write_fidelity(const Fidelity& fidelity, const std::filesystem::path& folder);

}  // namespace aims
