// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/files/table.hpp"
#include "core/measurements.hpp"

namespace aims {

/// Rate at which the statistics are taken [Hz].
inline constexpr double kImuStatisticsRate = 400.0;

/// One statistic of an IMU on one axis, beside that of a real robot.
struct ImuStatistic {
  std::string quantity;
  std::string unit;
  char axis = 'x';
  double simulated = 0.0;
  double real_low = 0.0;   ///< smallest figure of the real robot
  double real_high = 0.0;  ///< largest figure of the real robot
  bool comparable = true;  ///< false: the real robot also did what the simulated one did not

  /// How many times the simulated figure is larger or smaller than the nearest real one; 1 within.
  double factor() const;
};

/// Statistics of a trot: samples at `kImuStatisticsRate`, taken at an instant. The real figures are
/// of the body IMU of a trotting Unitree Go1, 16 s at 400 Hz; it also turned, so that its spread
/// of the yaw rate is not comparable. None for less than 8 s.
std::optional<std::vector<ImuStatistic>> trot_statistics(std::span<const ImuSample> samples);

/// Spread while standing; the same robot. None for less than 2 s.
std::optional<std::vector<ImuStatistic>> standing_statistics(std::span<const ImuSample> samples);

/// A row per quantity: per axis the simulated figure, the real one, and the factor between them.
TextTable imu_statistics_table(const std::vector<ImuStatistic>& statistics);

}  // namespace aims
