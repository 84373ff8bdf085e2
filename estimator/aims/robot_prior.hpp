// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/interface/learned.hpp"

namespace aims {

/// Of all numbers of a prior, in whatever unit.
inline constexpr double kLargestPrior = 1e6;

/// What is known of this robot beforehand, from a calibration: per quantity the numbers of
/// `numbers_of`; none: not known.
struct RobotPriorConfig {
  bool enabled = false;
  std::string file;                        ///< that it was read from, for messages
  std::vector<double> legs_by_feet;        ///< scale [-] and bias [m/s], measured foot by foot
  std::vector<double> legs_as_reported;    ///< the same of reported velocities
  std::vector<double> joint_compliance;    ///< [rad/m]
  std::vector<double> lidar_mount;         ///< rotation against the rig [rad]
  std::vector<double> imu_delay;           ///< [s]
  std::vector<double> gyro_bias;           ///< [rad/s]
  std::vector<double> accelerometer_bias;  ///< [m/s^2]
};

void describe(Fields& fields, RobotPriorConfig& config);

/// Error for a quantity with a wrong count of numbers or no covariance, naming its key.
Result<void> check(const RobotPriorConfig& config);

/// A quantity of the prior: its key, which is its name in a calibration, and how many values.
struct PriorQuantity {
  std::string_view name;
  int size;
  std::vector<double> RobotPriorConfig::*numbers;
};

/// Largest scale of legs that a robot has, four deviations of an unknown one (kFeetScaleSigma):
/// beyond it their lengths are wrong [-].
inline constexpr double kMostLegScale = 0.16;

/// What is implausible in the values of that quantity, with what was expected; empty: nothing.
std::string implausible(std::string_view name, std::span<const double> values);

/// All of them.
inline constexpr std::array kPriorQuantities = {
    PriorQuantity{"legs_by_feet", 6, &RobotPriorConfig::legs_by_feet},
    PriorQuantity{"legs_as_reported", 6, &RobotPriorConfig::legs_as_reported},
    PriorQuantity{"joint_compliance", 1, &RobotPriorConfig::joint_compliance},
    PriorQuantity{"lidar_mount", 3, &RobotPriorConfig::lidar_mount},
    PriorQuantity{"imu_delay", 1, &RobotPriorConfig::imu_delay},
    PriorQuantity{"gyro_bias", 3, &RobotPriorConfig::gyro_bias},
    PriorQuantity{"accelerometer_bias", 3, &RobotPriorConfig::accelerometer_bias},
};

/// The quantity as far as it is known.
std::optional<Gaussian> known(const RobotPriorConfig& config, std::string_view name);

/// The belief with those entries of the state, which depend on no other, as `values` say.
Belief with_entries(Belief belief, int offset, const Gaussian& values);

/// The belief after measuring three entries of the state, which others depend on.
Belief with_measured(const Belief& belief, ErrorState::Block at, const Gaussian& values);

}  // namespace aims
