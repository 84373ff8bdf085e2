// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/alignment.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <limits>

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

/// The rotation nearest to those of truth against estimate (chordal mean; they are alike).
Eigen::Quaterniond mean_rotation(std::span<const PosePair> pairs) {
  const auto rotation_of = [](const PosePair& each) {
    return each.truth.rotation * each.estimate.rotation.conjugate();
  };
  const Eigen::Quaterniond first = rotation_of(pairs.front());
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const PosePair& each : pairs) {
    const Eigen::Quaterniond rotation = rotation_of(each);
    sum += rotation.dot(first) < 0.0 ? -rotation.coeffs() : rotation.coeffs();
  }
  return Eigen::Quaterniond(sum).normalized();
}

/// The pairs of the second half of a span of time.
std::span<const PosePair> second_half(std::span<const PosePair> pairs) {
  const Time middle = pairs.front().stamp + (pairs.back().stamp - pairs.front().stamp) / 2;
  while (pairs.front().stamp < middle) pairs = pairs.subspan(1);
  return pairs;
}

/// The rotation nearest to `start` that turns the line of the estimate onto that of the truth.
Eigen::Quaterniond along_line(const Eigen::Quaterniond& start, const Eigen::Vector3d& line_truth,
                              const Eigen::Vector3d& line_estimate) {
  return Eigen::Quaterniond::FromTwoVectors(start * line_estimate, line_truth) * start;
}

}  // namespace

std::span<const PosePair> standing_start(std::span<const PosePair> pairs) {
  constexpr double kDistance = 0.05;  // [m]
  constexpr double kAngle = 0.05;     // [rad]
  constexpr Duration kLongest = 10 * kSecond;
  constexpr Duration kShortest = 500 * kMillisecond;
  const auto stands = [&first = pairs.front()](const PosePair& each) {
    return each.stamp - first.stamp <= kLongest &&
           (each.truth.translation - first.truth.translation).norm() <= kDistance &&
           each.truth.rotation.angularDistance(first.truth.rotation) <= kAngle;
  };
  std::size_t count = 1;
  while (count < pairs.size() && stands(pairs[count])) ++count;
  const bool long_enough = pairs[count - 1].stamp - pairs.front().stamp >= kShortest;
  return pairs.first(long_enough ? count : 1);
}

Alignment align_start(std::span<const PosePair> pairs, AlignmentKind kind) {
  Alignment alignment{.T_truth_estimate = Pose(),
                      .kind = kind,
                      .spread = pairs.empty() ? PositionSpread::kPoint : PositionSpread::kFull};
  if (pairs.empty()) return alignment;
  if (kind == AlignmentKind::kStartPose) {
    const auto start = second_half(standing_start(pairs));
    alignment.T_truth_estimate = about_means(moments_of(start), mean_rotation(start));
    return alignment;
  }
  const PosePair& first = pairs.front();
  const Eigen::Quaterniond rotation =
      kind == AlignmentKind::kStartYaw ? align_yaw(pairs).T_truth_estimate.rotation
      : kind == AlignmentKind::kStartSe3
          ? align_se3(pairs).T_truth_estimate.rotation
          : yaw_rotation(yaw_of(first.truth.rotation) - yaw_of(first.estimate.rotation));
  alignment.T_truth_estimate = {rotation,
                                first.truth.translation - rotation * first.estimate.translation};
  return alignment;
}

Alignment align_se3(std::span<const PosePair> pairs) {
  Alignment alignment{Pose(), AlignmentKind::kSe3, PositionSpread::kPoint};
  if (pairs.empty()) return alignment;
  constexpr double kZero = std::numeric_limits<double>::epsilon();  // of evo [m^2]
  const Moments m = moments_of(pairs);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m.covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d& U = svd.matrixU();
  const Eigen::Matrix3d& V = svd.matrixV();
  Eigen::Quaterniond rotation = mean_rotation(pairs.first(1));
  if (svd.singularValues()[1] > kZero) {
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    if (U.determinant() * V.determinant() < 0.0) signs.z() = -1.0;
    rotation = Eigen::Quaterniond(Eigen::Matrix3d(U * signs.asDiagonal() * V.transpose()));
    alignment.spread = PositionSpread::kFull;
  } else if (svd.singularValues()[0] > kZero) {
    rotation = along_line(rotation, U.col(0), V.col(0));
    alignment.spread = PositionSpread::kLine;
  }
  alignment.T_truth_estimate = about_means(m, rotation.normalized());
  return alignment;
}

Alignment align_sim3(std::span<const PosePair> pairs) {
  Alignment alignment = align_se3(pairs);
  alignment.kind = AlignmentKind::kSim3;
  if (pairs.empty()) return alignment;
  const Moments m = moments_of(pairs);
  double variance = 0.0;
  for (const PosePair& each : pairs) {
    variance += (each.estimate.translation - m.mean_estimate).squaredNorm() /
                static_cast<double>(pairs.size());
  }
  const Eigen::Quaterniond& rotation = alignment.T_truth_estimate.rotation;
  // The trace of D S in Umeyama's terms: of the covariance along the aligned estimate.
  const double along = (rotation.toRotationMatrix().transpose() * m.covariance).trace();
  if (!(variance > 0.0) || !(along > 0.0)) return alignment;
  alignment.scale = along / variance;
  alignment.T_truth_estimate.translation =
      m.mean_truth - rotation * (alignment.scale * m.mean_estimate);
  return alignment;
}

Alignment align_yaw(std::span<const PosePair> pairs) {
  Alignment alignment{Pose(), AlignmentKind::kYaw, PositionSpread::kPoint};
  if (pairs.empty()) return alignment;
  const Moments m = moments_of(pairs);
  // Maximizes the trace of R(yaw) against the horizontal cross-covariance.
  const double sine = m.covariance(1, 0) - m.covariance(0, 1);
  const double cosine = m.covariance(0, 0) + m.covariance(1, 1);
  const bool spreads = std::hypot(sine, cosine) > 1e-12;
  if (spreads) alignment.spread = PositionSpread::kFull;
  const double yaw = spreads ? std::atan2(sine, cosine) : 0.0;
  alignment.T_truth_estimate = about_means(m, yaw_rotation(yaw));
  return alignment;
}

Pose aligned(const Pose& estimate, const Alignment& alignment) {
  Pose scaled = estimate;
  if (alignment.scale != 1.0) scaled.translation *= alignment.scale;
  return alignment.T_truth_estimate * scaled;
}

std::vector<PosePair> aligned(std::vector<PosePair> pairs, const Alignment& alignment) {
  for (PosePair& each : pairs) each.estimate = aligned(each.estimate, alignment);
  return pairs;
}

}  // namespace aims
