// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/scan_series.hpp"

#include <cmath>
#include <limits>

#include "estimator/baselines/points/translation_constraint.hpp"

namespace aims::leg_kilo {
namespace {

PoseCovariance stated(const Belief& belief) {
  const Eigen::Matrix3d R = belief.state.T_world_body.R();
  const auto& P = belief.covariance;
  return {R.transpose() * part(P, Error::kPosition, Error::kPosition) * R,
          part(P, Error::kRotation, Error::kRotation)};
}

/// The normals of the planes as rows, each divided by the deviation of its residual if `weighted`.
Eigen::Matrix<double, Eigen::Dynamic, 3> normals_of(const ScanReport& report, double factor,
                                                    bool weighted) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> normals(report.matches.size(), 3);
  for (Eigen::Index i = 0; i < normals.rows(); ++i) {
    const PointOnPlane& match = report.matches[static_cast<std::size_t>(i)];
    const double weight = weighted ? 1.0 / std::sqrt(factor * match.variance) : 1.0;
    normals.row(i) = weight * match.normal.transpose();
  }
  return normals;
}

double mean_distance(const ScanReport& report) {
  double sum = 0.0;
  for (const PointOnPlane& match : report.matches) sum += std::abs(match.distance);
  const auto count = static_cast<double>(report.matches.size());
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<SeriesInfo> scan_series() {
  return {{"points_in", "-", "points after the voxel filter"},
          {"points_used", "-", "points that lay on a plane"},
          {std::string(kIterationsSeries), "-", "updates by groups of points; 0: none"},
          {"standing_feet", "-", "standing feet per IMU sample"},
          {"residual_mean", "m", "mean absolute distance of points from planes before the updates"},
          {"smallest_eigenvalue", "1/m^2", "smallest eigenvalue of the translation information"},
          {"condition_number", "-", "condition number of the translation information"},
          {"localizability", "-", "sum of the cosines between normals and the weakest direction"}};
}

ScanRow scan_row(const ScanReport& report, const Belief& belief, double variance_factor,
                 Time stamp) {
  const points::TranslationConstraint information =
      points::translation_constraint(normals_of(report, variance_factor, true));
  const points::TranslationConstraint directions =
      points::translation_constraint(normals_of(report, variance_factor, false));
  const double feet = report.imu_samples > 0
                          ? static_cast<double>(report.standing_feet) / report.imu_samples
                          : std::numeric_limits<double>::quiet_NaN();
  return {stamp,
          stated(belief),
          {static_cast<double>(report.points), static_cast<double>(report.matches.size()),
           static_cast<double>(report.updates), feet, mean_distance(report), information.smallest,
           information.condition, directions.localizability}};
}

}  // namespace aims::leg_kilo
