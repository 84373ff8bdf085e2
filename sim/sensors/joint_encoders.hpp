// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>

#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"
#include "sim/sensors/leg_odometry_config.hpp"

namespace aims {

/// Angles and rates at the encoders, which sit on the motors' side of a compliant leg.
struct JointMotion {
  JointVector angle = JointVector::Zero();  ///< [rad]
  JointVector rate = JointVector::Zero();   ///< [rad/s]
};

/// Encoders of the twelve joints: offset, noise and resolution of the angle; the rate is either
/// the true one with noise, or the difference of two readings, half the window late. Both are late
/// by the delay.
class JointEncoders {
 public:
  /// `offset` is the constant error of each angle [rad]. Random streams: "leg.encoder",
  /// "leg.encoder_window".
  JointEncoders(const LegOdometryConfig& config, Duration timestep, const JointVector& offset,
                std::uint64_t run_seed);

  /// Takes the motion after a physics step; call once per step.
  void update(const JointMotion& motion);

  /// Fills the joint angles and rates of `sample` with readings of the motion a delay ago.
  void read(LegOdometrySample& sample);

 private:
  double reading(double angle, double noise) const;
  JointMotion motion_before(double steps) const;

  LegOdometryConfig config_;
  JointVector offset_;
  std::size_t window_;    ///< physics steps, 0: the rate is not differenced
  double window_length_;  ///< [s]
  double delay_;          ///< physics steps
  RandomStream noise_, window_noise_;
  std::deque<JointMotion> motions_;  ///< of the last window and delay, oldest first
};

}  // namespace aims
