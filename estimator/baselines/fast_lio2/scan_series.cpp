// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/scan_series.hpp"

#include <limits>

#include "estimator/baselines/points/translation_constraint.hpp"

namespace aims::fast_lio2 {
namespace {

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
  const points::TranslationConstraint constraint =
      points::translation_constraint(update.residuals.jacobian.middleCols<3>(Error::kPosition));
  const double mean =
      distances.size() > 0 ? distances.cwiseAbs().mean() : std::numeric_limits<double>::quiet_NaN();
  return {stamp,
          stated(update.belief),
          {static_cast<double>(points), static_cast<double>(distances.size()),
           static_cast<double>(update.iterations), update.converged ? 1.0 : 0.0, mean,
           constraint.smallest / variance, constraint.condition, constraint.localizability}};
}

}  // namespace aims::fast_lio2
