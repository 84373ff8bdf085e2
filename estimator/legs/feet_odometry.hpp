// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/filter/imu_history.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/legs/feet.hpp"
#include "estimator/legs/joint_compliance.hpp"
#include "estimator/legs/leg_states.hpp"
#include "estimator/legs/leg_velocity_model.hpp"

namespace aims {

/// Where the true vertical velocity is known from, against which feet show their compliance.
enum class VerticalReference {
  kHeight,       ///< the height of the belief, which scans correct
  kLevelGround,  ///< nothing measures it: the ground is taken as level on average
};

/// Turns leg packets with joint angles into measurements of the base velocity, foot by foot.
class FeetOdometry {
 public:
  FeetOdometry(const FeetConfig& config, const SensorRig& rig, double gravity,
               VerticalReference vertical)
      : config_(config), rig_(rig), gravity_(gravity), vertical_(vertical) {}

  /// Whether the packet has joint angles: then its velocity is not to be fused.
  bool applies(const LegOdometrySample& sample) const;

  /// The measurement by `sample` for `belief`, whose time is the stamp; empty while no foot stands
  /// or no earlier packet gives joint rates. It is linearized where the feet were measured, a few
  /// milliseconds earlier. Call once per packet that applies.
  std::optional<LinearMeasurement> measure(const LegOdometrySample& sample, const Belief& belief,
                                           const ImuHistory& imu);

  JointCompliance& compliance() { return compliance_; }
  const JointCompliance& compliance() const { return compliance_; }

  /// The last measured velocity with the means of `leg_velocity_model`.
  const LegVelocity& velocity() const { return velocity_; }

 private:
  /// State and motion at an instant.
  struct Instant {
    NominalState state;
    InertialSegment motion;
  };
  /// What the weights of feet depend on besides their velocities.
  struct FootSelection {
    std::array<bool, kLegCount> contact;
    Eigen::Vector3d predicted;  ///< velocity of the base, base axes [m/s]
    double variance;            ///< of it, per axis [m^2/s^2]
    FootWeights weights(const FootVelocities& feet) const {
      return weights_of_feet(feet, contact, predicted, variance);
    }
  };
  Instant instant_before(Time stamp, double age, const NominalState& state, const ImuHistory& imu);
  std::optional<JointState> joints_of_packet(const LegOdometrySample& sample,
                                             const NominalState& state);
  double rate_of(const JointState& joints) const;
  void learn_compliance(const JointState& joints, const Eigen::Vector3d& turning,
                        const Eigen::Vector3d& up, const FootSelection& select, double climb);
  double climb_since_last(Time stamp, double height);
  std::array<bool, kLegCount> contacts_of(const LegOdometrySample& sample);

  FeetConfig config_;
  SensorRig rig_;
  double gravity_;
  VerticalReference vertical_;
  JointDifference difference_;
  JointCompliance compliance_;
  Time last_stamp_ = 0;
  double last_height_ = 0.0;  ///< of the belief when angles were last new [m]
  StrideMeans stride_means_;  ///< of the predicted velocity: that of a foot is too noisy
  LegVelocity velocity_;
  bool contacts_reported_ = false;  ///< by any packet so far
  std::vector<InertialSegment> segments_;
};

}  // namespace aims
