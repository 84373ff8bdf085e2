// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "estimator/aims/config.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// What the feet of one sample say about its velocity.
struct StanceEvidence {
  bool told = false;  ///< the sample has joints; without them it says nothing about its feet
  int standing = 0;   ///< feet judged to stand
  /// Standard deviation among the velocities of the base that each standing foot tells by itself,
  /// base axes [m/s]; zero with fewer than two.
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();
};

/// Compares the standing feet of `sample` with each other, never with the velocity it reports:
/// wrong lengths of the legs shift all feet alike. `angular_velocity` is that of the base, in base
/// axes [rad/s].
StanceEvidence compare_feet(const LegOdometrySample& sample,
                            const Eigen::Vector3d& angular_velocity,
                            const LegGeometry& geometry = kLegGeometry);

/// What else tells how good a sample is.
struct LegCircumstances {
  double yaw_rate = 0.0;  ///< of the base [rad/s]
  double gap = 0.0;       ///< time without packets before this one, beyond the period [s]
};

/// Covariance of the velocity of one sample [m^2/s^2], base axes: that of a firm stance where
/// nothing speaks against it.
Eigen::Matrix3d evident_variance(const LegEvidenceConfig& config, const StanceEvidence& stance,
                                 const LegCircumstances& circumstances);

/// By how much the covariance of a sample is to grow whose innovation has the chi-square `distance`
/// (3 degrees of freedom): 1 within the gate, in proportion beyond it, empty where it is to be
/// dropped.
std::optional<double> gate_inflation(const LegEvidenceConfig& config, double distance);

/// Noise of the samples of one walk, from their own evidence.
class LegEvidence {
 public:
  LegEvidence(const LegEvidenceConfig& config, const LegConfig& leg);

  /// Covariance of `sample` as it is to be fused [m^2/s^2], when consecutive samples repeat each
  /// other's error. `angular_velocity` is that of the base, in base axes [rad/s].
  Eigen::Matrix3d noise(const LegOdometrySample& sample, const Eigen::Vector3d& angular_velocity);

  /// By how much the noise of `measurement`, of the sample last given to noise(), is to grow under
  /// the covariance of the state's error; empty where the sample is to be dropped. An innovation
  /// that lasts is no slip, and passes.
  std::optional<double> inflation(const LinearMeasurement& measurement,
                                  const ErrorMatrix& covariance);

 private:
  LegEvidenceConfig config_;
  double period_;   ///< of the packets [s]
  double repeats_;  ///< samples per correlation time
  std::optional<Time> last_;
  std::optional<Time> outside_since_;  ///< first of the samples outside the gate
};

}  // namespace aims
