// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/leg_geometry.hpp"
#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "estimator/legs/feet.hpp"

namespace aims {

/// Angles of the links beyond their encoders for W / K = 1 rad/m under those shares of the load
/// [m]; `angle` at the encoders [rad], `up` in base axes.
JointVector yield_of_joints(const JointVector& angle, const LoadShares& shares,
                            const Eigen::Vector3d& up, const LegGeometry& geometry);

/// Compliance of the joints: under the load f a link lies beyond its encoder by J^T f / K, with the
/// stiffness K. Loads are seldom calibrated, so f_i = W s_i u with the share s_i of a foot in the
/// mean sum W of all loads, along the upward unit vector u, and W / K [rad/m] is one unknown.
///
/// A leg that yields gives way at touchdown and springs back after the foot has left the ground,
/// where it no longer counts: by its encoders the robot sinks, or climbs, with every step. So the
/// mean vertical velocity by the feet, against the true one, shows W / K; what happens within a
/// stance does not, since other errors of a foot look alike there. Rubber feet that the weight
/// compresses by W / k sink likewise, without shortening a stride; lengths of links and rolling let
/// rigid legs drift too, by a constant that no time averages out. W / K is the most probable value
/// under its prior and those of W / k and of this constant.
class JointCompliance {
 public:
  /// Stiff legs, as those of a Unitree Go1; soft ones (80 N m/rad under 12 kg) have 1.5 rad/m.
  static constexpr double kPrior = 0.05;
  /// Deviation about it [rad/m].
  static constexpr double kSigma = 0.4;

  double value() const { return value_; }  ///< W / K [rad/m]

  /// The part of the way that joints of this value take, by which rigid legs would be too short, as
  /// far as it is learned; 0 before a metre of walking [-].
  double part_of_way() const;

  /// Whether it has walked long enough, or is known: the value then stays, and with it the scale of
  /// the legs.
  bool is_learned() const;
  /// Whether update() still changes anything.
  bool learns() const;
  /// Holds the value that another run has found, with its deviation [rad/m], until the drift of
  /// this one contradicts it.
  void know(double value, double sigma);
  bool contradicted() const { return contradicted_; }

  /// What the drift alone says, without prior: information [m^2/rad^2] and its product with the
  /// value that makes the drift zero.
  double information() const;
  double information_vector() const;

  /// The shares s_i of the loads of `sample`, at `rate_hz` [Hz]. Zero without loads. Call once per
  /// sample: they follow the mean load.
  LoadShares shares(const LegOdometrySample& sample, double rate_hz);

  /// What feet drift vertically, mean over the feet that stand.
  struct Drift {
    double climb = 0.0;   ///< vertical velocity by rigid legs minus the true one [m/s]
    double joints = 0.0;  ///< its derivative by W / K [m^2/(rad s)]
    double rubber = 0.0;  ///< its derivative by W / k [1/s]
    double along = 0.0;   ///< derivative of the velocity along the way by W / K [m^2/(rad s)]
    double speed = 0.0;   ///< level [m/s]
  };
  /// Adds a packet's `drift`, at `rate_hz` [Hz]. Learns for 20 s, then stays.
  void update(const Drift& drift, double rate_hz);

 private:
  void judge_known();
  double variance() const;
  double beyond_rubber() const;

  double value_ = kPrior;
  double mean_load_ = 0.0;  ///< of all feet together
  double walked_ = 0.0;     ///< time of the means [s]
  Drift mean_;
  std::optional<double> known_variance_;
  bool contradicted_ = false;
};

}  // namespace aims
