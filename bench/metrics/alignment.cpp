// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/alignment.hpp"

#include <Eigen/SVD>
#include <cmath>

namespace aims {
namespace {

/// Means and cross-covariance of the positions of pairs.
struct Moments {
  Eigen::Vector3d mean_estimate = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d mean_truth = Eigen::Vector3d::Zero();     ///< [m]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();     ///< truth by estimate [m^2]
};

Moments moments_of(std::span<const PosePair> pairs) {
  Moments m;
  const auto count = static_cast<double>(pairs.size());
  for (const PosePair& each : pairs) {
    m.mean_estimate += each.estimate.translation / count;
    m.mean_truth += each.truth.translation / count;
  }
  for (const PosePair& each : pairs) {
    m.covariance += (each.truth.translation - m.mean_truth) *
                    (each.estimate.translation - m.mean_estimate).transpose() / count;
  }
  return m;
}

Pose about_means(const Moments& m, const Eigen::Quaterniond& rotation) {
  return {rotation, m.mean_truth - rotation * m.mean_estimate};
}

}  // namespace

Alignment align_start(std::span<const PosePair> pairs, AlignmentKind kind) {
  Alignment alignment{.T_truth_estimate = Pose(), .kind = kind, .degenerate = pairs.empty()};
  if (pairs.empty()) return alignment;
  const PosePair& first = pairs.front();
  if (kind == AlignmentKind::kStartPose) {
    alignment.T_truth_estimate = first.truth * first.estimate.inverse();
    return alignment;
  }
  const Eigen::Quaterniond rotation =
      yaw_rotation(yaw_of(first.truth.rotation) - yaw_of(first.estimate.rotation));
  alignment.T_truth_estimate = {rotation,
                                first.truth.translation - rotation * first.estimate.translation};
  return alignment;
}

Alignment align_se3(std::span<const PosePair> pairs, double straightness) {
  if (pairs.size() < 3) {
    Alignment fallback = align_yaw(pairs);
    fallback.degenerate = true;
    return fallback;
  }
  const Moments m = moments_of(pairs);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m.covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& singular = svd.singularValues();
  if (!(singular[1] > straightness * singular[0])) {
    Alignment fallback = align_yaw(pairs);
    fallback.degenerate = true;
    return fallback;
  }
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;
  const Eigen::Matrix3d R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return {about_means(m, Eigen::Quaterniond(R).normalized()), AlignmentKind::kSe3, false};
}

Alignment align_yaw(std::span<const PosePair> pairs) {
  Alignment alignment{.T_truth_estimate = Pose(), .kind = AlignmentKind::kYaw, .degenerate = true};
  if (pairs.empty()) return alignment;
  const Moments m = moments_of(pairs);
  // Maximizes the trace of R(yaw) against the horizontal cross-covariance.
  const double sine = m.covariance(1, 0) - m.covariance(0, 1);
  const double cosine = m.covariance(0, 0) + m.covariance(1, 1);
  alignment.degenerate = !(std::hypot(sine, cosine) > 1e-12);
  const double yaw = alignment.degenerate ? 0.0 : std::atan2(sine, cosine);
  alignment.T_truth_estimate = about_means(m, yaw_rotation(yaw));
  return alignment;
}

std::vector<PosePair> aligned(std::span<const PosePair> pairs, const Alignment& alignment) {
  std::vector<PosePair> moved(pairs.begin(), pairs.end());
  for (PosePair& each : moved) each.estimate = alignment.T_truth_estimate * each.estimate;
  return moved;
}

}  // namespace aims
