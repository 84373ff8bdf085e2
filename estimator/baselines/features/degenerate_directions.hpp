// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace aims::features {

/// Which directions of the state the residuals constrain (Zhang, Kaess and Singh, "On degeneracy of
/// optimization-based state estimation problems", ICRA 2016): those eigenvectors of A^T A whose
/// eigenvalue reaches a threshold.
struct ConstrainedDirections {
  Eigen::MatrixXd projection;        ///< V_kept V_kept^T, onto the constrained directions
  int removed = 0;                   ///< directions below the threshold
  double smallest_eigenvalue = 0.0;  ///< of A^T A
};

/// The constrained directions of the information `AtA`, a symmetric matrix of any size.
ConstrainedDirections constrained_directions(const Eigen::MatrixXd& AtA, double threshold);

}  // namespace aims::features
