// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/config.hpp"
#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/kalman_update.hpp"
#include "estimator/legs/leg_velocity_model.hpp"

namespace aims {

/// Velocity noise without a stance foot; also the most that a gap adds [m/s].
inline constexpr double kNoFootSigma = 0.5;

/// Squared Mahalanobis distance above which the noise of a sample grows: chi-square, 3 dof, 99.9 %.
inline constexpr double kLegGate = 16.3;

/// Growth of the variance above which a sample is rejected [-].
inline constexpr double kMaxVarianceGrowth = 100.0;

/// Noise of each leg sample from its stance feet, the yaw rate, lost packets and its innovation.
struct LegNoiseConfig {
  bool enabled = false;
  /// Of one sample with consistent stance feet, base axes [m/s]; the scale is a separate state.
  Eigen::Vector3d velocity_sigma{0.07, 0.07, 0.07};
  double nominal_spread = 0.2;  ///< of the velocities from feet that do not slip [m/s]
};

void describe(Fields& fields, LegNoiseConfig& config);

/// Base velocities implied by the single stance feet of one sample.
struct StanceFeet {
  bool measured = false;  ///< the sample has joint angles and rates
  int count = 0;          ///< feet in contact
  /// Standard deviation among the base velocities from each foot alone, base axes [m/s]; zero with
  /// fewer than two feet.
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();
};

/// Compares the stance feet of `sample` with each other, not with the reported velocity: wrong leg
/// lengths change all feet alike. `angular_velocity` is that of the base, base axes [rad/s].
StanceFeet compare_stance_feet(const LegOdometrySample& sample,
                               const Eigen::Vector3d& angular_velocity,
                               const LegGeometry& geometry);

/// Further inputs of the leg noise model.
struct LegConditions {
  double yaw_rate = 0.0;  ///< of the base [rad/s]
  double gap = 0.0;       ///< time without packets before this one, beyond the period [s]
};

/// Covariance of the velocity of one sample [m^2/s^2], base axes: the nominal one plus a term for
/// the spread of the feet, missing feet, the yaw rate and the gap.
Eigen::Matrix3d sample_covariance(const LegNoiseConfig& config, const StanceFeet& feet,
                                  const LegConditions& conditions);

/// Factor on the covariance of a sample whose innovation has the squared Mahalanobis distance
/// `distance` (3 dof): 1 within the gate, distance / gate beyond it, empty for a rejected sample.
std::optional<double> gate_inflation(double distance);

/// Leg noise model over a sequence of samples.
class LegNoiseModel {
 public:
  LegNoiseModel(const LegNoiseConfig& config, const SensorRig& rig);

  /// Covariance of `sample` for the update [m^2/s^2], including the correlation of consecutive
  /// samples. `angular_velocity` is that of the base, base axes [rad/s].
  Eigen::Matrix3d noise(const LegOdometrySample& sample, const Eigen::Vector3d& angular_velocity);

  /// Factor on the noise of `measurement`, of the sample last given to noise(), under the state
  /// covariance `covariance`; empty for a rejected sample. A large innovation that lasts longer
  /// than a slip does (0.5 s) is accepted.
  std::optional<double> inflation(const LinearMeasurement& measurement,
                                  const ErrorMatrix& covariance);

 private:
  LegNoiseConfig config_;
  LegGeometry geometry_;
  double period_;              ///< of the packets [s]
  double correlated_samples_;  ///< that share one error
  std::optional<Time> last_;
  std::optional<Time> outside_since_;  ///< first of the consecutive samples outside the gate
};

}  // namespace aims
