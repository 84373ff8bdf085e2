// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/adaptive_weights.hpp"

#include <cmath>

namespace aims {

AdaptiveWeights::AdaptiveWeights(const DegeneracyConfig& config)
    : config_(config), severity_(config.alpha) {}

void AdaptiveWeights::assess(double residual_variance, ScanDiagnostics& diagnostics) {
  if (!config_.enabled) return;
  const double prior_sigma = diagnostics.residual_sigma_prior;
  diagnostics.O_lidar = effective_observability(residual_variance, config_.sigma_0);
  diagnostics.O_lidar_prior = effective_observability(prior_sigma * prior_sigma, config_.sigma_0);
  const double O_lidar = config_.prior_residuals ? diagnostics.O_lidar_prior : diagnostics.O_lidar;
  const bool imu_alone = config_.prediction == ConsistencyPrediction::kImu &&
                         std::isfinite(diagnostics.C_IL_imu);
  diagnostics.C_IL = imu_alone ? diagnostics.C_IL_imu : diagnostics.C_IL_imu_legs;
  diagnostics.D = degeneracy_severity(O_lidar, diagnostics.C_IL, config_);  // eq. (7)
  severity_.update(diagnostics.D);                                          // eq. (12)
  gamma_lidar_ = lidar_reliability(severity_.value(), config_);
  gamma_leg_ = leg_reliability(severity_.value(), config_);
}

void AdaptiveWeights::record(ScanDiagnostics& diagnostics) const {
  if (config_.enabled) diagnostics.D_smoothed = severity_.value();
  diagnostics.gamma_lidar = gamma_lidar_;
  diagnostics.gamma_leg = gamma_leg_;
}

}  // namespace aims
