// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "core/config.hpp"
#include "core/random.hpp"
#include "core/time.hpp"
#include "sim/run_seeds.hpp"

namespace aims {

/// Errors of one inertial triad, as in a datasheet; unit: rad/s or m/s^2.
struct InertialErrorConfig {
  double noise_density = 0.0;  ///< white noise [unit/sqrt(Hz)]
  double bias_walk = 0.0;      ///< random walk of the bias [unit/sqrt(s)]
  double turn_on_bias = 0.0;   ///< standard deviation per axis of the bias at the start [unit]
  double scale_error = 0.0;    ///< standard deviation per axis of the scale, drawn per run [-]
  double range = 0.0;          ///< magnitude at which each axis saturates [unit]
  double misalignment = 0.0;   ///< standard deviation of each cross-axis term, drawn per run [-]
  double drift = 0.0;          ///< standard deviation per axis of the bias's slow drift [unit]
  double drift_time = 300.0;   ///< correlation time of the drift [s]
  double g_sensitivity = 0.0;  ///< of a gyro: standard deviation of each term [rad/s per m/s^2]
  double resolution = 0.0;     ///< step of the output; 0: not quantized [unit]
};
/// The fields with `prefix` before their names. A gyro has a `g_sensitivity`.
void describe_errors(Fields& f, std::string_view prefix, InertialErrorConfig& c);

/// First-order Gauss-Markov process, as a temperature moves a bias: it changes once a second and is
/// linear in between, so that it does not depend on the rate at which it is asked.
class BiasDrift {
 public:
  /// Random stream: `name`. The process has its stationary variance from the start.
  BiasDrift(double sigma, double correlation_time, std::uint64_t run_seed, std::string_view name);

  /// At a time not before that of the last call, which starts with the first call.
  Eigen::Vector3d at(Time stamp);

 private:
  double kept_;   ///< of the value after a second
  double added_;  ///< standard deviation of what a second adds
  RandomStream random_;
  Eigen::Vector3d before_;
  Eigen::Vector3d after_;
  Time second_ = -1;  ///< that of `before_`, once started [ns]
};

/// One triad of an IMU: its errors and their state.
class InertialTriad {
 public:
  /// Random streams: `name` (bias, scale, noise), `name`.axes (misalignment, g-sensitivity) and
  /// `name`.drift. `interval` between samples [s]; noise of at least `bandwidth` [Hz].
  InertialTriad(const InertialErrorConfig& errors, double interval, double bandwidth,
                RunSeeds seeds, std::string_view name);

  /// The output for a true value, under that specific force [m/s^2].
  Eigen::Vector3d measure(Time stamp, const Eigen::Vector3d& truth, const Eigen::Vector3d& force);

  const Eigen::Vector3d& bias() const { return bias_; }  ///< of the next sample

 private:
  InertialErrorConfig errors_;
  double walk_step_;    ///< of the bias between samples [unit]
  double noise_sigma_;  ///< of a sample [unit]
  RandomStream random_;
  Eigen::Vector3d walked_;  ///< turn-on bias and random walk
  Eigen::Vector3d scale_;
  Eigen::Matrix3d cross_axis_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d g_sensitivity_ = Eigen::Matrix3d::Zero();
  BiasDrift drift_;
  Eigen::Vector3d bias_;
};

}  // namespace aims
