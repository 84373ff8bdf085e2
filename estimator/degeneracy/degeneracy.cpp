// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/degeneracy.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace aims {

void describe(Fields& f, DegeneracyConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "weigh LiDAR and legs by the degeneracy index"});
  f.flag("prior_residuals", c.prior_residuals,
         {"", any(), "O_lidar from the residuals before the trial update", "eq. (4)"});
  f.choice(
      "prediction", c.prediction,
      {{"imu", ConsistencyPrediction::kImu}, {"imu_and_legs", ConsistencyPrediction::kImuAndLegs}},
      {"", any(), "what C_IL compares the LiDAR with", "eq. (6): imu"});
  f.number("sigma_0", c.sigma_0,
           {"m", positive_up_to(1e4), "nominal residual dispersion", "eq. (4)"});
  f.number(
      "kappa", c.kappa,
      {"-", positive_up_to(1e6), "saturation of C_IL; chi-square of 6 dof at 95 %", "eq. (7)"});
  f.number("w1", c.w1, {"-", in_range(0.0, 1.0), "weight of 1 - O_lidar; w2 = 1 - w1", "eq. (7)"});
  f.number("eta", c.eta, {"-", up_to(1e6), "LiDAR sensitivity to degeneration", "eq. (8)"});
  f.number("gamma_min", c.gamma_min,
           {"-", in_range(0.01, 1.0), "smallest reliability of the legs", "eq. (10)"});
  f.number("alpha", c.alpha,
           {"-", in_half_open(0.0, 1.0), "smoothing of D_k per scan", "eq. (12)"});
}

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

double consistency_full(const ErrorVector& innovation, const ErrorMatrix& predicted_covariance) {
  const double c = innovation.dot(predicted_covariance.llt().solve(innovation));  // eq. (6)
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
