// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/degeneracy.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace aims {

ResidualStatistics residual_statistics(std::span<const double> residuals) {
  ResidualStatistics statistics;
  if (residuals.empty()) return statistics;
  const auto count = static_cast<double>(residuals.size());
  for (double r : residuals) statistics.mean += r;
  statistics.mean /= count;  // eq. (3), left
  for (double r : residuals) {
    statistics.variance += (r - statistics.mean) * (r - statistics.mean);
  }
  statistics.variance /= count;  // eq. (3), right
  return statistics;
}

double effective_observability(double residual_variance, double sigma_0) {
  return residual_variance / (residual_variance + sigma_0 * sigma_0);  // eq. (4)
}

double consistency(const Vector6& innovation, const Matrix6& predicted_covariance) {
  const double c = innovation.dot(predicted_covariance.llt().solve(innovation));  // eq. (6)
  return std::isfinite(c) ? std::max(c, 0.0) : 0.0;
}

double consistency_full(const ErrorVector& innovation, const ErrorMatrix& predicted_information) {
  const double c = innovation.dot(predicted_information * innovation);  // eq. (6)
  return std::isfinite(c) ? std::max(c, 0.0) : 0.0;
}

double degeneracy_severity(double O_lidar, double C_IL, const DegeneracyConfig& config) {
  const double w2 = 1.0 - config.w1;
  return config.w1 * (1.0 - O_lidar) + w2 * C_IL / (C_IL + config.kappa);  // eq. (7)
}

double lidar_reliability(double D, const DegeneracyConfig& config) {
  return std::exp(-config.eta * D);  // eq. (8)
}

double leg_reliability(double D, const DegeneracyConfig& config) {
  return config.gamma_min + (1.0 - config.gamma_min) * (1.0 - D);  // eq. (10)
}

double SeverityFilter::update(double D) {
  value_ = started_ ? alpha_ * value_ + (1.0 - alpha_) * D : D;  // eq. (12)
  started_ = true;
  return value_;
}

}  // namespace aims
