// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/degenerate_directions.hpp"

#include <Eigen/Eigenvalues>

namespace aims::features {

ConstrainedDirections constrained_directions(const Eigen::MatrixXd& AtA, double threshold) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(AtA);
  ConstrainedDirections directions;
  directions.projection = Eigen::MatrixXd::Identity(AtA.rows(), AtA.cols());
  directions.smallest_eigenvalue = solver.eigenvalues()[0];
  for (Eigen::Index i = 0; i < AtA.rows(); ++i) {
    if (solver.eigenvalues()[i] >= threshold) continue;
    const Eigen::VectorXd free_direction = solver.eigenvectors().col(i);
    directions.projection -= free_direction * free_direction.transpose();
    ++directions.removed;
  }
  return directions;
}

}  // namespace aims::features
