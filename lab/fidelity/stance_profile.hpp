// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/files/table.hpp"
#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "sim/robot/truth.hpp"

namespace aims {

/// Rate at which the legs are sampled for a profile [Hz].
inline constexpr double kStanceProfileRate = 400.0;

/// What the encoders and the force sensor of one foot say at an instant, beside the true motion of
/// the trunk.
struct FootReading {
  double slip = 0.0;    ///< forward speed over the ground, without rolling [m/s]
  double height = 0.0;  ///< of the foot's centre [m]
  double load = 0.0;    ///< as measured; in a profile over its mean in mid-stance
};
using FeetReadings = std::array<FootReading, kLegCount>;

/// Readings at the samples of the legs that have a neighbour before and after: joint rates are
/// central differences of the angles. `legs` and the truth share their stamps.
std::vector<FeetReadings> foot_readings(const Truth& truth, std::span<const LegOdometrySample> legs,
                                        const LegGeometry& geometry);

/// The beginning and the end of a stance: the slip speed passes 0.5 m/s.
enum class StanceEvent { kTouchdown, kLiftOff };

/// Mean over all stances at a time since touchdown or lift-off, beside that of a real robot.
/// Heights count from their mean in mid-stance, the middle third; loads over theirs, less the
/// reading in mid-swing.
struct StanceBin {
  StanceEvent event = StanceEvent::kTouchdown;
  double time = 0.0;  ///< since the event [s]
  FootReading simulated;
  FootReading real;
};

/// The profile of a steady trot, readings at `kStanceProfileRate`. The real robot is a Unitree Go1
/// that trots at 0.93 m/s with strides of 0.502 s under motion capture (public repository
/// mrsp/serow, GPL-3.0), mean over 12 strides and four feet. None without a whole stance.
std::optional<std::vector<StanceBin>> stance_profile(std::span<const FeetReadings> readings);

/// How many of the bins lie within 25 % of the real figure, or within a floor where that is small.
struct StanceAgreement {
  std::string quantity;
  std::size_t within = 0;
  std::size_t bins = 0;
  double worst = 0.0;  ///< largest difference over its tolerance; 1 at most when all are within
};

/// Of slip speed (floor 0.1 m/s), height (2 mm) and load (0.1).
std::vector<StanceAgreement> stance_agreement(const std::vector<StanceBin>& profile);

/// The difference over its tolerance for slip, height and load.
std::array<double, 3> stance_deviation(const StanceBin& bin);

TextTable stance_profile_table(const std::vector<StanceBin>& profile);
TextTable stance_agreement_table(const std::vector<StanceAgreement>& agreement);

}  // namespace aims
