// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/lidar/drift_search.hpp"

namespace aims {
namespace {

/// Largest distance of the neighbours from their plane, in deviations of a residual [-].
constexpr double kMaxThickness = 3.0;

/// Residual at which a robust weight is one half, in deviations of a residual and of the plane's
/// own points together [-]. At an edge the points lie on either side of their plane, and so do the
/// returns: the plane is right on average, which a kernel without that part would undo
/// (docs/decisions.md).
constexpr double kKernelScale = 5.0;

/// Largest difference between the residuals to the planes of both halves, in deviations of a
/// residual [-]: where they differ the surface is no plane (docs/estimators.md).
constexpr double kMaxDisagreement = 1.0;

/// Largest residual of noise, in its deviations [-].
constexpr double kNoise = 3.0;

/// The row with the sign of its normal turned to that of `other`.
PlaneRow aligned(PlaneRow row, const PlaneRow& other) {
  using E = ErrorState;
  if (segment(row.jacobian, E::kPosition).dot(segment(other.jacobian, E::kPosition)) >= 0.0) {
    return row;
  }
  return {-row.residual, -row.jacobian};
}

/// Whether both rows of a match, `b` aligned to `a`, are within the gates; `sigma` is the deviation
/// of a residual [m].
bool is_accepted(const PlaneRow& a, const PlaneRow& b, double sigma) {
  return std::abs(0.5 * (a.residual + b.residual)) <= kMaxResidual &&
         !(std::abs(a.residual - b.residual) > kMaxDisagreement * sigma);
}

/// Sums over the rows of both halves: with s = j_a + j_b, d = j_a - j_b and the residuals alike,
/// the sums of j_a j_a^T + j_b j_b^T and of j_a j_b^T + j_b j_a^T are half the sum and half the
/// difference of those of s s^T and d d^T.
class HalvesSum {
 public:
  void add(const PlaneRow& a, const PlaneRow& b, double weight) {
    add(a.jacobian + b.jacobian, a.residual + b.residual, weight, sum_);
    add(a.jacobian - b.jacobian, a.residual - b.residual, weight, difference_);
  }

  HalvesInformation halves() const {
    return {0.25 * (sum_.matrix + difference_.matrix), 0.25 * (sum_.matrix - difference_.matrix),
            0.25 * (sum_.vector + difference_.vector), 0.25 * (sum_.vector - difference_.vector)};
  }

 private:
  static void add(const Vector6& row, double residual, double weight, PoseInformation& to) {
    const Vector6 weighted = weight * row;
    to.matrix.noalias() += weighted * row.transpose();
    to.vector += weighted * residual;
  }

  PoseInformation sum_;
  PoseInformation difference_;
};

}  // namespace

ScanMatcher::ScanMatcher(double correlated_points, const RobustKernelConfig& kernel)
    : correlated_points_(correlated_points), kernel_(kernel) {}

void ScanMatcher::reset(const Eigen::Vector3d& sensor) {
  sensor_ = sensor;
  robust_ = false;
}

void ScanMatcher::match(const Pose& T_odom_body, std::span<const Eigen::Vector3f> points,
                        const VoxelMap& map, std::size_t stride) {
  matches_.clear();
  unmatched_.clear();
  const Eigen::Matrix3d R = T_odom_body.R();
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Eigen::Vector3d p_body = points[i].cast<double>();
    const Eigen::Vector3d p_odom = R * p_body + T_odom_body.translation;
    const PlanePair planes = map.planes_at(p_odom.cast<float>());
    const bool valid = planes.valid();
    if (!valid || std::abs(planes.a.distance(p_odom)) > kMaxResidual) unmatched_.push_back(p_body);
    if (!valid) continue;
    const double cosine = std::abs(planes.a.normal.dot(R * (p_body - sensor_).normalized()));
    const double thickest = std::max(planes.a.thickness, planes.b.thickness);
    const double sigma = noise_.sigma(cosine);
    if (thickest > kMaxThickness * sigma) continue;
    const double scale = kKernelScale * std::sqrt(sigma * sigma + thickest * thickest);
    matches_.push_back({p_body, planes, cosine, sigma, scale});
  }
}

MatchInformation ScanMatcher::linearize(const Pose& T_odom_body) {
  HalvesSum sum;
  residuals_.clear();
  incident_residuals_.clear();
  const Eigen::Matrix3d R = T_odom_body.R();
  const Eigen::Vector3d& t = T_odom_body.translation;
  for (const Match& match : matches_) {
    const PlaneRow a = plane_row(match.planes.a, match.p_body, R, t);
    const PlaneRow b = aligned(plane_row(match.planes.b, match.p_body, R, t), a);
    const double residual = 0.5 * (a.residual + b.residual);
    if (!is_accepted(a, b, match.sigma)) continue;
    const double ratio = robust_ ? residual / match.scale : 0.0;
    const double weight = 1.0 / (correlated_points_ * match.sigma * match.sigma);
    sum.add(a, b, weight / (1.0 + ratio * ratio));  // Cauchy
    residuals_.push_back(residual);
    incident_residuals_.push_back({residual, match.cosine});
  }
  return {sum.halves(), static_cast<int>(residuals_.size())};
}

std::vector<Correspondence> ScanMatcher::correspondences(const Pose& T_odom_body) const {
  std::vector<Correspondence> accepted;
  accepted.reserve(matches_.size());
  const Eigen::Matrix3d R = T_odom_body.R();
  for (const Match& match : matches_) {
    const PlaneRow a = plane_row(match.planes.a, match.p_body, R, T_odom_body.translation);
    const PlaneRow b =
        aligned(plane_row(match.planes.b, match.p_body, R, T_odom_body.translation), a);
    const double residual = 0.5 * (a.residual + b.residual);
    if (!is_accepted(a, b, match.sigma)) continue;
    const Vector6 jacobian = 0.5 * (a.jacobian + b.jacobian);
    const Eigen::Vector3d normal = segment(jacobian, ErrorState::kPosition);
    accepted.push_back({match.p_body, normal, R.transpose() * normal, residual});
  }
  return accepted;
}

Agreement ScanMatcher::agreement(const Pose& T_odom_body, const Eigen::Vector3d& axis) const {
  Agreement agreement;
  for (const Match& match : matches_) {
    const Plane& plane = match.planes.a;
    if (std::abs(plane.distance(T_odom_body * match.p_body)) > kNoise * match.sigma) continue;
    ++agreement.all;
    if (faces_along(plane, axis)) ++agreement.facing;
  }
  return agreement;
}

std::span<const MappedPlane> ScanMatcher::mapped_planes(const Pose& T_odom_body,
                                                        const VoxelMap& map) {
  mapped_planes_.clear();
  for (const Match& match : matches_) {
    const Eigen::Vector3d p_odom = T_odom_body * match.p_body;
    mapped_planes_.push_back(
        {match.planes.a.normal, map.covariance_at(p_odom.cast<float>()).cast<double>()});
  }
  return mapped_planes_;
}

}  // namespace aims
