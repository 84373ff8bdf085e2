// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "core/config.hpp"
#include "estimator/filter/error_state.hpp"

namespace aims {

/// The prediction that C_IL compares the LiDAR with.
enum class ConsistencyPrediction {
  kImu,         ///< of the IMU alone since the last scan, as the paper defines it
  kImuAndLegs,  ///< of the filter, which also holds the leg updates since the last scan
};

/// Reliability assessment and adaptive weights, eqs. (3)-(12).
struct DegeneracyConfig {
  bool enabled = false;          ///< weigh LiDAR and legs by the index
  bool prior_residuals = false;  ///< O_lidar from the residuals before the trial update
  ConsistencyPrediction prediction = ConsistencyPrediction::kImu;  ///< of C_IL, eq. (6)
  double sigma_0 = 0.008;  ///< nominal residual dispersion, eq. (4) [m]
  double kappa = 12.6;     ///< saturation of C_IL, eq. (7) [-]
  double w1 = 0.5;         ///< weight of 1 - O_lidar, eq. (7); w2 = 1 - w1 [-]
  double eta = 3.0;        ///< LiDAR sensitivity, eq. (8) [-]
  double gamma_min = 0.3;  ///< smallest leg reliability, eq. (10) [-]
  double alpha = 0.9;      ///< smoothing of D_k per scan, eq. (12) [-]
};

void describe(Fields& fields, DegeneracyConfig& config);

/// Mean and variance of residuals, eq. (3).
struct ResidualStatistics {
  double mean = 0.0;      ///< [m]
  double variance = 0.0;  ///< [m^2]
};

/// Eq. (3); zeros without residuals.
ResidualStatistics residual_statistics(std::span<const double> residuals);

/// O_lidar, eq. (4), in [0, 1): small where the residuals vary little.
double effective_observability(double residual_variance, double sigma_0);

/// C_IL = y^T P^-1 y, eq. (6), over the pose block (6-D).
double consistency(const Vector6& innovation, const Matrix6& predicted_covariance);

/// C_IL, eq. (6), over the full error state.
double consistency_full(const ErrorVector& innovation, const ErrorMatrix& predicted_covariance);

/// D_k, eq. (7), in [0, 1]: 0 = healthy, 1 = degenerate.
double degeneracy_severity(double O_lidar, double C_IL, const DegeneracyConfig& config);

/// gamma_lidar, eq. (8), in [exp(-eta), 1]; R_lidar' = R_lidar / gamma_lidar, eq. (9).
double lidar_reliability(double D, const DegeneracyConfig& config);

/// gamma_leg, eq. (10), in [gamma_min, 1]; R_leg' = R_leg / gamma_leg, eq. (11).
double leg_reliability(double D, const DegeneracyConfig& config);

/// The smoothed index, eq. (12); it starts at the first D_k.
class SeverityFilter {
 public:
  explicit SeverityFilter(double alpha) : alpha_(alpha) {}

  /// Adds D_k and returns the smoothed index.
  double update(double D);

  double value() const { return value_; }

 private:
  double alpha_;
  double value_ = 0.0;
  bool started_ = false;
};

}  // namespace aims
