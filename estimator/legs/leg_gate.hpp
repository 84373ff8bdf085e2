// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Squared Mahalanobis distance above which the noise of a sample grows: chi-square, 3 dof, 99.9 %.
inline constexpr double kLegGate = 16.3;

/// Growth of the variance above which a sample is rejected [-], at twice the residual that the gate
/// passes (docs/decisions.md#the-gate-of-leg-samples).
inline constexpr double kMaxVarianceGrowth = 4.0;

/// Gate of leg samples by their innovation: slipping feet.
struct LegGateConfig {
  bool enabled = false;
};

void describe(Fields& fields, LegGateConfig& config);

/// Factor on the covariance of a sample whose innovation has the squared Mahalanobis distance
/// `distance` (3 dof): 1 within the gate, distance / gate beyond it, empty for a rejected sample.
std::optional<double> gate_inflation(double distance);

/// The gate over a sequence of leg samples at a nominal rate [Hz].
class LegGate {
 public:
  explicit LegGate(double rate_hz);

  /// Factor on the noise of `measurement`, of a sample at `stamp`, under the state covariance
  /// `covariance`; empty for a rejected sample. A large innovation that lasts longer than a slip
  /// does (0.5 s) is accepted.
  std::optional<double> inflation(Time stamp, const LinearMeasurement& measurement,
                                  const ErrorMatrix& covariance);

 private:
  double correlated_samples_;
  std::optional<Time> outside_since_;  ///< first of the consecutive samples outside the gate
};

}  // namespace aims
