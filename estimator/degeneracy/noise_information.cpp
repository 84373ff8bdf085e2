// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/degeneracy/noise_information.hpp"

#include <Eigen/LU>
#include <cmath>

namespace aims {
namespace {

/// Keeps a block without information invertible; far below the information of one return.
constexpr double kRegularization = 1e-9;

}  // namespace

void describe(Fields& f, NoiseInformationConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "remove the information that the noise of plane normals adds to a scan"});
  f.number(
      "scale", c.scale,
      {"-", positive_up_to(1e6), "factor on the noise-induced information from the plane fits"});
  f.number(
      "significance_ratio", c.significance_ratio,
      {"-", in_range(1.0, 1e6), "ratio of information to noise with half acceptance probability"});
  f.number("warmup_excess", c.warmup_excess,
           {"-", up_to(1e6), "fraction by which that ratio is larger at the start"});
  f.number("warmup_distance", c.warmup_distance,
           {"m", positive_up_to(1e4), "distance over which the excess decays"});
  f.number(
      "bootstrap_distance", c.bootstrap_distance,
      {"m", up_to(1e4), "distance from the start over which information need not be significant"});
  f.number(
      "log_sigma", c.log_sigma,
      {"-", positive_up_to(1e6), "deviation of the logarithm of the noise-induced information"});
  f.number("averaging_distance", c.averaging_distance,
           {"m", positive_up_to(1e4), "distance over which information is averaged"});
  f.number("axis_tolerance", c.axis_tolerance,
           {"rad", up_to(100.0), "rotation of the axes within which they are kept"});
}

Matrix6 noise_information(const Eigen::Matrix3d& normal_covariance, const Eigen::Vector3d& p_body,
                          const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d turning = hat(p_body) * R.transpose();
  const Eigen::Matrix3d cross = turning * normal_covariance;
  Matrix6 sum;
  sum.topLeftCorner<3, 3>().noalias() = cross * turning.transpose();
  sum.topRightCorner<3, 3>() = cross;
  sum.bottomLeftCorner<3, 3>() = cross.transpose();
  sum.bottomRightCorner<3, 3>() = normal_covariance;
  return sum;
}

Eigen::Matrix3d schur_complement(const Eigen::Matrix3d& block, const Eigen::Matrix3d& cross,
                                 const Eigen::Matrix3d& other) {
  const Eigen::Matrix3d covariance =
      (other + kRegularization * Eigen::Matrix3d::Identity()).inverse();
  const Eigen::Matrix3d rest = block - cross * covariance * cross.transpose();
  return 0.5 * (rest + rest.transpose());
}

double significance_threshold(const NoiseInformationConfig& config, double distance) {
  const double excess = config.warmup_excess * std::exp(-distance / config.warmup_distance);
  return config.significance_ratio * (1.0 + excess);
}

double acceptance_probability(double ratio, double threshold,
                              const NoiseInformationConfig& config) {
  if (!(ratio > 0.0)) return 0.0;
  const double deviations = std::log(ratio / threshold) / config.log_sigma;
  return 0.5 * std::erfc(-deviations / std::sqrt(2.0));
}

}  // namespace aims
