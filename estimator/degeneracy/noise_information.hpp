// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/filter/error_state.hpp"

namespace aims {

/// Removal of the information that the noise of plane normals adds to a scan.
struct NoiseInformationConfig {
  bool enabled = false;
  /// Factor on the noise-induced information from the plane fits, whose residuals at edges
  /// overstate it. 0.7 is the smallest ratio measured between walls without features [-].
  double scale = 0.7;
  double significance_ratio = 1.35;  ///< to the noise: half acceptance probability [-]
  /// The map of a standing start holds one noise sample, seen in every scan: the significance ratio
  /// is larger by this fraction at the start and decays over `warmup_distance` [-].
  double warmup_excess = 0.3;
  double warmup_distance = 8.0;  ///< [m]
  /// Over this distance from the start, information beyond noise is accepted before it is
  /// significant: the map is only as sharp as the poses that built it [m].
  double bootstrap_distance = 5.0;
  double log_sigma = 0.05;          ///< of the logarithm of the noise-induced information [-]
  double averaging_distance = 1.5;  ///< of the information [m]
  double axis_tolerance = 0.02;     ///< within which the axes are kept [rad]
};

void describe(Fields& fields, NoiseInformationConfig& config);

/// Expected contribution of one noisy plane normal to A = H^T R^-1 H: M C M^T, with the derivative
/// M = [hat(p) R^T; I] of the row with respect to the normal, the normal's covariance C (odometry
/// axes) and p in body axes [m].
Matrix6 noise_information(const Eigen::Matrix3d& normal_covariance, const Eigen::Vector3d& p_body,
                          const Eigen::Matrix3d& R);

/// Information of a block with the other block, of information `other`, unknown: the Schur
/// complement of `other`; `cross` is the off-diagonal block, 3x3 each.
Eigen::Matrix3d schur_complement(const Eigen::Matrix3d& block, const Eigen::Matrix3d& cross,
                                 const Eigen::Matrix3d& other);

/// Ratio to noise with half acceptance probability, `distance` [m] after the start:
/// significance_ratio (1 + warmup_excess exp(-distance / warmup_distance)).
double significance_threshold(const NoiseInformationConfig& config, double distance);

/// Probability that information of `ratio` times the noise-induced one exceeds noise, whose
/// logarithm has the deviation `log_sigma`: Phi(ln(ratio / threshold) / log_sigma).
double acceptance_probability(double ratio, double threshold, const NoiseInformationConfig& config);

}  // namespace aims
