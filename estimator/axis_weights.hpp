// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/directional_config.hpp"
#include "estimator/error_state.hpp"

namespace aims {

/// The information of a scan along six axes of the pose, against what noisy normals would give by
/// chance. The axes are those of the pencil (A, C): A = V^-T diag(ratio) V^-1 and C = V^-T V^-1, so
/// that neither the units of rotation and position nor the frame matter.
struct AxisWeights {
  Matrix6 axes = Matrix6::Identity();      ///< V, one axis per column
  Matrix6 back = Matrix6::Identity();      ///< V^-T
  Vector6 ratio = Vector6::Constant(1e9);  ///< of information to chance, ascending
  Vector6 weights = Vector6::Ones();       ///< in [0, 1]

  /// V^-T diag(w ratio) V^-1, the information that is kept.
  Matrix6 weigh_matrix() const;

  /// V^-T diag(w) V^T b, the part of a gradient that is kept.
  Vector6 weigh_vector(const Vector6& b) const;
};

/// What the errors of one plane's normal add to A on average: M C M^T, M = [hat(p) R^T; I] the
/// derivative of the row in the normal, C its covariance (odometry axes) and p in body axes [m].
Matrix6 chance_information(const Eigen::Matrix3d& normal_covariance, const Eigen::Vector3d& p_body,
                           const Eigen::Matrix3d& R);

/// Probability that information `ratio` times what chance gives is more than chance: chance itself
/// is known but for a factor (log-normal).
double reality(double ratio, const SpuriousConfig& config);

/// Information `A` = H^T R^-1 H without the part that normals of noise would give: `chance` is
/// the expectation of dH^T R^-1 dH over their errors. Each axis keeps p (ratio - 1) / ratio of its
/// information, p the probability that it is real (cf. Hatleskog and Alexis 2024).
AxisWeights weigh_axes(const Matrix6& A, const Matrix6& chance, const SpuriousConfig& config);

}  // namespace aims
