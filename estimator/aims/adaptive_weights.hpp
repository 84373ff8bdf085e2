// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/aims/scan_diagnostics.hpp"
#include "estimator/degeneracy/degeneracy.hpp"

namespace aims {

/// The paper's degeneracy index of each scan and the weights that it gives LiDAR and legs, eqs. (4)
/// to (12). Where `config` does not enable it, both weights stay 1.
class AdaptiveWeights {
 public:
  explicit AdaptiveWeights(const DegeneracyConfig& config);

  /// Assesses a scan by the variance of its residuals [m^2] and by what `diagnostics` has of C_IL
  /// and of the residuals before the update; fills in O_lidar, C_IL and D_k.
  void assess(double residual_variance, ScanDiagnostics& diagnostics);

  /// Fills in the smoothed index and the weights after the last scan that was assessed.
  void record(ScanDiagnostics& diagnostics) const;

  double gamma_lidar() const { return gamma_lidar_; }  ///< eq. (8); R_lidar' = R_lidar / gamma
  double gamma_leg() const { return gamma_leg_; }      ///< eq. (10); R_leg' = R_leg / gamma

 private:
  DegeneracyConfig config_;
  SeverityFilter severity_;
  double gamma_lidar_ = 1.0;
  double gamma_leg_ = 1.0;
};

}  // namespace aims
