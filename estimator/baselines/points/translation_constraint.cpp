// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/points/translation_constraint.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace aims::points {
namespace {

/// A normal counts when its angle to a direction is so small that it constrains it (X-ICP, Tuna et
/// al. 2023, its lower threshold: 80 degrees).
constexpr double kMinCosine = 0.1736;

}  // namespace

TranslationConstraint translation_constraint(
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3>>& normals) {
  TranslationConstraint constraint;
  if (normals.rows() == 0) return constraint;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      Eigen::Matrix3d(normals.transpose() * normals));
  const Eigen::Vector3d values = solver.eigenvalues().cwiseMax(0.0);
  constraint.smallest = values.x();
  constraint.condition = values.z() / std::max(values.x(), 1e-12);
  const Eigen::ArrayXd cosines = (normals * solver.eigenvectors().col(0)).array().abs();
  constraint.localizability = (cosines > kMinCosine).select(cosines, 0.0).sum();
  return constraint;
}

}  // namespace aims::points
