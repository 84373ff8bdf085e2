// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/scan_series.hpp"

#include <Eigen/Eigenvalues>
#include <limits>

namespace aims::fast_lio2 {
namespace {

/// Least cosine between a normal and a direction that it constrains (X-ICP, Tuna et al. 2023,
/// its lower threshold: 80 degrees).
constexpr double kMinCosine = 0.1736;

/// Constraint of the translation by the residuals.
struct Constraint {
  double smallest = std::numeric_limits<double>::quiet_NaN();   ///< eigenvalue of N^T N [-]
  double condition = std::numeric_limits<double>::quiet_NaN();  ///< largest over smallest [-]
  double localizability = std::numeric_limits<double>::quiet_NaN();
};

Constraint constraint_of(const ScanResiduals& residuals) {
  Constraint constraint;
  if (residuals.distances.size() == 0) return constraint;
  const auto normals = residuals.jacobian.middleCols<3>(Error::kPosition);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      Eigen::Matrix3d(normals.transpose() * normals));
  const Eigen::Vector3d values = solver.eigenvalues().cwiseMax(0.0);
  constraint.smallest = values.x();
  constraint.condition = values.z() / std::max(values.x(), 1e-12);
  const Eigen::ArrayXd cosines = (normals * solver.eigenvectors().col(0)).array().abs();
  constraint.localizability = (cosines > kMinCosine).select(cosines, 0.0).sum();
  return constraint;
}

PoseCovariance stated(const Belief& belief) {
  const Eigen::Matrix3d R = belief.state.T_world_body.R();
  const auto& P = belief.covariance;
  return {R.transpose() * part(P, Error::kPosition, Error::kPosition) * R,
          part(P, Error::kRotation, Error::kRotation)};
}

}  // namespace

std::vector<SeriesInfo> scan_series() {
  return {{"points_in", "-", "points after the voxel filter"},
          {"points_used", "-", "points with an accepted plane in the last iteration"},
          {std::string(kIterationsSeries), "-", "iterations; 0: no update"},
          {"converged", "-", "1: the last iteration made a small step"},
          {"residual_mean", "m", "mean absolute residual before the last step"},
          {"smallest_eigenvalue", "1/m^2", "smallest eigenvalue of the translation information"},
          {"condition_number", "-", "condition number of the translation information"},
          {"localizability", "-", "sum of the cosines between normals and the weakest direction"}};
}

ScanRow scan_row(const Update& update, std::size_t points, double variance, Time stamp) {
  const Eigen::VectorXd& distances = update.residuals.distances;
  const Constraint constraint = constraint_of(update.residuals);
  const double mean =
      distances.size() > 0 ? distances.cwiseAbs().mean() : std::numeric_limits<double>::quiet_NaN();
  return {stamp,
          stated(update.belief),
          {static_cast<double>(points), static_cast<double>(distances.size()),
           static_cast<double>(update.iterations), update.converged ? 1.0 : 0.0, mean,
           constraint.smallest / variance, constraint.condition, constraint.localizability}};
}

}  // namespace aims::fast_lio2
