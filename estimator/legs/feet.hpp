// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <deque>
#include <optional>

#include "core/config.hpp"
#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"

namespace aims {

/// Leg odometry from the joints: each foot measures the velocity of the base on its own.
struct FeetConfig {
  bool enabled = false;  ///< where samples have joint angles; else the reported velocity is fused
};

void describe(Fields& fields, FeetConfig& config);

/// The load on each foot as a part of the mean load on all.
using LoadShares = Eigen::Matrix<double, kLegCount, 1>;

/// Joints at an instant, and how they yield.
struct JointPacket {
  Time stamp = 0;
  JointVector angle = JointVector::Zero();  ///< at the encoders [rad]
  JointVector yield = JointVector::Zero();  ///< link beyond encoder, per unit of compliance [m]
  LoadShares load = LoadShares::Zero();
};

/// Means over the interval between two readings.
struct JointState {
  JointVector angle = JointVector::Zero();       ///< [rad]
  JointVector rate = JointVector::Zero();        ///< of the angle [rad/s]
  JointVector yield_rate = JointVector::Zero();  ///< of the yield [m/s]
  LoadShares load_rate = LoadShares::Zero();     ///< [1/s]
  double age = 0.0;                              ///< middle of the interval, before its end [s]
  int repeats = 0;                               ///< readings sent again since the last new one
};

/// Differences joint angles: the rates that drivers report are filtered and late by an unknown
/// time, while the middle of an interval is known. Angles that a driver sends again under new
/// stamps, until it has read its encoders, are no reading: their difference would be zero.
class JointDifference {
 public:
  /// Empty at the start, after a gap, and for angles that are sent again.
  std::optional<JointState> update(const JointPacket& reading);

 private:
  bool is_repeat(const JointPacket& reading);

  std::deque<JointPacket> past_;  ///< new readings of the last milliseconds
  JointVector angle_ = JointVector::Zero();
  Time changed_ = 0;  ///< when the angles last changed
  Time last_ = 0;     ///< of the last packet, new or not
  int repeats_ = 0;   ///< since the last new reading
};

using FootVelocities = std::array<Eigen::Vector3d, kLegCount>;
using FootWeights = std::array<double, kLegCount>;

/// The velocity of the base in base axes [m/s] that each foot implies if it stands and rolls,
/// z_i = -(omega x p_i + J_i q_dot_i) + (omega + omega_calf_i) x r u, with the angular velocity
/// omega of the base (`turning`, base axes [rad/s]), the upward unit vector u in base axes, and
/// the joint rates q_dot of `rate` + `compliance` * `yield_rate`.
FootVelocities velocities_from_feet(const JointState& joints, double compliance,
                                    const Eigen::Vector3d& turning, const Eigen::Vector3d& up,
                                    const LegGeometry& geometry);

/// How far each foot is taken to stand, 0 to 1. A swinging foot moves over the ground by metres per
/// second, which load sensors report tens of milliseconds late. So each foot weighs by its
/// agreement with the velocity that the IMU predicts (`predicted`, base axes, with `variance` per
/// axis): w_i = 1 / (1 + |y_i|^2 / (c^2 + 2 variance))^2 with the innovation y_i, the Geman-McClure
/// kernel. Without a detected contact it is a tenth of that, since a threshold may be too high.
/// Feet swing forward; a foot that moves backward over the ground yields, and its y_i counts 2/3.
/// The more uncertain the prediction, the less it decides.
FootWeights weights_of_feet(const FootVelocities& feet, const std::array<bool, kLegCount>& contact,
                            const Eigen::Vector3d& predicted, double variance);

/// Sum of the weights; 0 when too little is left for a measurement.
double total_weight(const FootWeights& weights);

/// The weighted mean. All feet measure the same velocity with the same Jacobian, so one update with
/// their mean equals four updates.
Eigen::Vector3d mean_of_feet(const FootVelocities& feet, const FootWeights& weights);

/// Variance of that mean per axis and sample [m^2/s^2] at `rate_hz` [Hz]: max(1, 2 tau f) sigma^2
/// over the sum of the weights, with sigma = 0.15 m/s of one standing foot, whose errors
/// consecutive samples share over tau = 20 ms.
double variance_of_feet(double weight, double rate_hz);

/// Joint angles are late by this on the IMU's clock, by encoders, their driver and the bus [s]
/// (docs/decisions.md#each-foot-is-a-measurement).
inline constexpr double kJointDelay = 6e-3;

}  // namespace aims
