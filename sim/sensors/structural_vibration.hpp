// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"
#include "sim/run_seeds.hpp"
#include "sim/sensors/low_pass.hpp"

namespace aims {

/// One mode of the structure between feet and IMU, and what it adds at the IMU.
struct VibrationMode {
  double frequency = 30.0;                                 ///< [Hz]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< per axis [m/s^2 per N]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();          ///< per axis [rad/s per N]
};
void describe(Fields& f, VibrationMode& c);

/// Vibration of the trunk that the rigid-body dynamics do not have.
struct VibrationConfig {
  double level = 0.0;       ///< share of the modes' levels; 0: no vibration by footfalls [-]
  double damping = 0.15;    ///< damping ratio of each mode [-]
  double variation = 0.05;  ///< of the logarithm of each level from run to run [-]
  /// Standing: motors and electronics, white up to 200 Hz, standard deviation per axis.
  double floor_acceleration = 0.0;  ///< [m/s^2]
  double floor_rate = 0.0;          ///< [rad/s]
  std::vector<VibrationMode> modes = go1_modes();

  static std::vector<VibrationMode> go1_modes();
};
void describe(Fields& f, VibrationConfig& c);

/// What vibration adds to the motion of the trunk, in body axes.
struct Vibration {
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();          ///< [rad/s]
};

/// Damped modes that the normal forces of the feet excite. Each mode passes the forces around its
/// frequency: footfalls ring, a constant load does nothing. The two diagonals of a trot shake an
/// axis with signs drawn per run.
class StructuralVibration {
 public:
  /// Random streams: "imu.vibration" (signs and levels), "imu.vibration.floor".
  StructuralVibration(const VibrationConfig& config, double timestep, RunSeeds seeds);

  bool active() const { return floor_acceleration_ > 0.0 || floor_rate_ > 0.0 || !modes_.empty(); }

  /// The vibration after one more physics step under these normal forces of the feet [N].
  Vibration step(const FootLoads& foot_load);

 private:
  /// A mode with its gains, drawn for the run: rows are axes, columns the diagonals.
  struct Mode {
    SecondOrderSystem system;  ///< its axes: the diagonals; the third is not used
    Eigen::Matrix<double, 3, 2> acceleration;
    Eigen::Matrix<double, 3, 2> rate;
  };
  std::vector<Mode> modes_;
  double floor_acceleration_;  ///< standard deviation of a step [m/s^2]
  double floor_rate_;          ///< [rad/s]
  RandomStream floor_;
  bool started_ = false;
};

}  // namespace aims
