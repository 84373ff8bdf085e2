// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/measurements.hpp"

namespace aims {

/// The sensors of an estimator, in the order of `Measurement`.
enum class Sensor { kImu, kLegs, kLidar };
inline constexpr int kSensorCount = 3;

/// What arrives from each sensor and how much of it can be used.
class InputMonitor {
 public:
  void accepted(Sensor sensor, Time arrival);
  void rejected(Sensor sensor, Time arrival);
  void accepted_force(const Eigen::Vector3d& specific_force);

  /// Whether the sensor has ever sent a usable measurement.
  bool seen(Sensor sensor) const { return of(sensor).last.has_value(); }
  /// Time [s] from the last usable measurement, or from the first arrival of any, to `now`.
  double silence(Sensor sensor, Time now) const;
  /// Fraction of the last measurements of the sensor that were rejected.
  double rejected_fraction(Sensor sensor) const { return of(sensor).rejected; }
  /// Magnitude of the mean specific force [m/s^2]; empty before `kForceSamples` samples.
  std::optional<double> mean_force() const;

  /// Samples that `mean_force` averages: several strides, whose accelerations average out.
  static constexpr int kForceSamples = 100;

 private:
  struct Input {
    std::optional<Time> last;  ///< arrival of the last usable measurement
    double rejected = 0.0;     ///< moving average
  };
  const Input& of(Sensor sensor) const { return inputs_[static_cast<std::size_t>(sensor)]; }
  Input& note(Sensor sensor, Time arrival, bool rejected);

  std::array<Input, kSensorCount> inputs_;
  std::optional<Time> first_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  int forces_ = 0;
};

}  // namespace aims
