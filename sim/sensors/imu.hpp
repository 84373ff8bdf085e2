// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/measurements.hpp"
#include "sim/robot/truth.hpp"
#include "sim/run_seeds.hpp"
#include "sim/sensors/inertial_errors.hpp"
#include "sim/sensors/low_pass.hpp"
#include "sim/sensors/structural_vibration.hpp"

namespace aims {

struct ImuConfig {
  double rate = 50.0;  ///< samples per second [Hz]
  ImuSampling sampling = ImuSampling::kMean;
  double bandwidth = 0.0;  ///< of the chip's low-pass before sampling; 0: none [Hz]
  int filter_order = 2;    ///< of that low-pass, 1 or 2
  InertialErrorConfig gyro = {2e-4, 2e-5, 2e-3, 0.0, 17.4};
  InertialErrorConfig accelerometer = {1.5e-3, 2e-4, 0.03, 0.0, 78.5};
  VibrationConfig vibration;
};
void describe(Fields& f, ImuConfig& c);

/// Error when the rate does not divide the physics rate.
Result<void> validate(const ImuConfig& config, Duration timestep);

/// An inertial measurement unit that moves with the body frame: true motion and vibration, the
/// chip's low-pass, sampling, the errors of the triads.
class Imu {
 public:
  /// `config` is valid. Random streams: those of InertialTriad under "imu.gyro" and
  /// "imu.accelerometer", and those of StructuralVibration. They do not depend on the rate, so that
  /// two outputs of one device share what is drawn per run.
  Imu(const ImuConfig& config, Duration timestep, RunSeeds seeds);

  /// Processes the true motion before the first and after each physics step, with the normal forces
  /// of the feet in that step [N]; returns a sample at the end of each interval. An average of
  /// rates is the rotation over the interval divided by its length; an average of specific forces
  /// is the mean of the force in the turning body's axes, so integrating it at the interval's
  /// middle attitude reproduces the change of velocity. What vibration and low-pass add is
  /// averaged.
  std::optional<ImuSample> sample(const TruthSample& motion, const FootLoads& loads = {});

  const Eigen::Vector3d& gyro_bias() const { return gyro_.bias(); }                    ///< [rad/s]
  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_.bias(); }  ///< [m/s^2]

 private:
  /// What the chip senses of a step beyond its true values.
  Vibration disturbance(const Vibration& truth, const FootLoads& loads);

  ImuSampling sampling_;
  int steps_;
  InertialTriad gyro_;
  InertialTriad accelerometer_;
  StructuralVibration vibration_;
  LowPass gyro_filter_;
  LowPass accelerometer_filter_;
  bool disturbed_;  ///< by vibration or low-pass
  std::optional<TruthSample> last_;
  TruthSample interval_start_;
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();  ///< over the interval's steps [m/s^2]
  Vibration disturbance_sum_;                            ///< over the interval's steps
  int count_ = 0;
};

}  // namespace aims
