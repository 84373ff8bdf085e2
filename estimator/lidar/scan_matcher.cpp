// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/degeneracy/noise_information.hpp"

namespace aims {
namespace {

/// Deviation of the first residuals: the accuracy that datasheets of spinning LiDARs state [m].
constexpr double kFirstSigma = 0.03;
/// No map of such returns is sharper [m].
constexpr double kLeastSigma = 0.005;
/// Scans over which it is averaged.
constexpr double kScans = 20.0;

}  // namespace

ScanMatcher::ScanMatcher(const LidarUpdateConfig& config, const RobustKernelConfig& kernel,
                         bool normal_noise)
    : config_(config), kernel_(kernel), normal_noise_(normal_noise), sigma_(kFirstSigma) {}

void ScanMatcher::match(const NominalState& state, std::span<const Eigen::Vector3f> points,
                        const VoxelMap& map) {
  matches_.clear();
  const Eigen::Matrix3f R = state.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f t = state.position.cast<float>();
  for (const Eigen::Vector3f& point : points) {
    const Plane plane = map.plane_at(R * point + t);
    if (plane.valid) matches_.push_back({point.cast<double>(), plane});
  }
}

MatchInformation ScanMatcher::linearize(const NominalState& state) {
  MatchInformation sum;
  residuals_.clear();
  const Eigen::Matrix3d R = state.rotation.toRotationMatrix();
  for (const Match& match : matches_) {
    const PlaneRow row = plane_row(match.plane, match.p_body, R, state.position);
    if (!(std::abs(row.residual) <= config_.residual_gate)) continue;
    const double ratio = row.residual / robust_scale_;
    const double weight = 1.0 / (1.0 + ratio * ratio);  // Cauchy
    const Vector6 weighted = weight * row.jacobian;
    sum.matrix.noalias() += weighted * row.jacobian.transpose();
    sum.vector.noalias() += weighted * row.residual;
    if (normal_noise_) {
      sum.noise += weight * noise_information(match.plane.normal_covariance, match.p_body, R);
    }
    residuals_.push_back(row.residual);
  }
  const double weight = 1.0 / (config_.correlated_points * sigma_ * sigma_);
  sum.matrix *= weight;
  sum.vector *= weight;
  sum.noise *= weight;
  sum.used = static_cast<int>(residuals_.size());
  return sum;
}

void ScanMatcher::update_robust_scale() {
  if (kernel_.enabled && !residuals_.empty()) robust_scale_ = kernel_.scale * deviation();
}

void ScanMatcher::learn_noise() {
  if (!residuals_.empty()) sigma_ += (deviation() - sigma_) / kScans;
}

/// Deviation of the last residuals from their median magnitude [m].
double ScanMatcher::deviation() {
  magnitudes_.clear();
  for (const double residual : residuals_) magnitudes_.push_back(std::abs(residual));
  const auto middle = magnitudes_.begin() + static_cast<std::ptrdiff_t>(magnitudes_.size() / 2);
  std::nth_element(magnitudes_.begin(), middle, magnitudes_.end());
  constexpr double kMedianOfNormal = 0.6745;  // median magnitude of a standard normal variable
  return std::max(*middle / kMedianOfNormal, kLeastSigma);
}

std::span<const MappedPlane> ScanMatcher::mapped_planes(const NominalState& state,
                                                        const VoxelMap& map) {
  mapped_planes_.clear();
  for (const Match& match : matches_) {
    const Eigen::Vector3d p_odom = state.T_odom_body() * match.p_body;
    mapped_planes_.push_back(
        {match.plane.normal, map.covariance_at(p_odom.cast<float>()).cast<double>()});
  }
  return mapped_planes_;
}

}  // namespace aims
