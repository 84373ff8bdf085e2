// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Largest distance of the neighbours from their plane, and the residual at which a robust weight
/// is one half, in deviations of a residual [-].
constexpr double kMaxThickness = 3.0;
constexpr double kKernelScale = 3.0;

/// Larger residuals are rejected [m].
constexpr double kMaxResidual = 0.2;

/// The row with the sign of its normal turned to that of `other`.
PlaneRow aligned(PlaneRow row, const PlaneRow& other) {
  using E = ErrorState;
  if (segment(row.jacobian, E::kPosition).dot(segment(other.jacobian, E::kPosition)) >= 0.0) {
    return row;
  }
  return {-row.residual, -row.jacobian};
}

/// Adds the rows of one point to `sum`.
void add(const PlaneRow& a, const PlaneRow& b, double weight, HalvesInformation& sum) {
  const Vector6 half_a = 0.5 * weight * a.jacobian;
  const Vector6 half_b = 0.5 * weight * b.jacobian;
  sum.within.noalias() += half_a * a.jacobian.transpose();
  sum.within.noalias() += half_b * b.jacobian.transpose();
  sum.across.noalias() += half_a * b.jacobian.transpose();
  sum.across.noalias() += half_b * a.jacobian.transpose();
  sum.within_vector.noalias() += half_a * a.residual + half_b * b.residual;
  sum.across_vector.noalias() += half_a * b.residual + half_b * a.residual;
}

}  // namespace

ScanMatcher::ScanMatcher(double correlated_points, const RobustKernelConfig& kernel)
    : correlated_points_(correlated_points), kernel_(kernel) {}

void ScanMatcher::reset(const Eigen::Vector3d& sensor) {
  sensor_ = sensor;
  robust_ = false;
}

void ScanMatcher::match(const NominalState& state, std::span<const Eigen::Vector3f> points,
                        const VoxelMap& map) {
  matches_.clear();
  const Eigen::Matrix3d R = state.rotation.toRotationMatrix();
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p_body = point.cast<double>();
    const PlanePair planes = map.planes_at((R * p_body + state.position).cast<float>());
    if (!planes.valid()) continue;
    const double cosine = std::abs(planes.a.normal.dot(R * (p_body - sensor_).normalized()));
    const double thickest = std::max(planes.a.thickness, planes.b.thickness);
    if (thickest <= kMaxThickness * noise_.sigma(cosine)) {
      matches_.push_back({p_body, planes, cosine});
    }
  }
}

MatchInformation ScanMatcher::linearize(const NominalState& state) {
  MatchInformation sum;
  residuals_.clear();
  incident_residuals_.clear();
  const Eigen::Matrix3d R = state.rotation.toRotationMatrix();
  for (const Match& match : matches_) {
    const PlaneRow a = plane_row(match.planes.a, match.p_body, R, state.position);
    const PlaneRow b = aligned(plane_row(match.planes.b, match.p_body, R, state.position), a);
    const double residual = 0.5 * (a.residual + b.residual);
    if (!(std::abs(residual) <= kMaxResidual)) continue;
    const double sigma = noise_.sigma(match.cosine);
    const double ratio = robust_ ? residual / (kKernelScale * sigma) : 0.0;
    const double weight = 1.0 / (correlated_points_ * sigma * sigma);
    add(a, b, weight / (1.0 + ratio * ratio), sum.halves);  // Cauchy
    residuals_.push_back(residual);
    incident_residuals_.push_back({residual, match.cosine});
  }
  sum.used = static_cast<int>(residuals_.size());
  return sum;
}

std::span<const MappedPlane> ScanMatcher::mapped_planes(const NominalState& state,
                                                        const VoxelMap& map) {
  mapped_planes_.clear();
  for (const Match& match : matches_) {
    const Eigen::Vector3d p_odom = state.T_odom_body() * match.p_body;
    mapped_planes_.push_back(
        {match.planes.a.normal, map.covariance_at(p_odom.cast<float>()).cast<double>()});
  }
  return mapped_planes_;
}

}  // namespace aims
