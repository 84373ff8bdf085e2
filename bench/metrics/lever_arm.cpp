// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/lever_arm.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <vector>

#include "bench/metrics/alignment.hpp"

namespace aims {
namespace {

constexpr int kSteps = 50;
constexpr std::size_t kFewest = 4;
/// A direction is observed where the rotation spreads it by more: about 6 degrees [-].
constexpr double kSpread = 0.01;

std::vector<PosePair> moved(std::span<const PosePair> pairs, const Eigen::Vector3d& lever) {
  std::vector<PosePair> points(pairs.begin(), pairs.end());
  for (PosePair& each : points) each.estimate.translation += each.estimate.rotation * lever;
  return points;
}

/// Normal equations of a small rotation, a translation and a change of the lever arm.
struct Normal {
  Eigen::Matrix<double, 9, 9> information = Eigen::Matrix<double, 9, 9>::Zero();
  Eigen::Matrix<double, 9, 1> gradient = Eigen::Matrix<double, 9, 1>::Zero();
};

Normal normal_of(std::span<const PosePair> points, const Alignment& alignment, bool level) {
  Normal normal;
  const Eigen::Matrix3d Q = alignment.T_truth_estimate.R();
  for (const PosePair& each : points) {
    Eigen::Matrix<double, 3, 9> J;
    const Eigen::Vector3d turned = Q * each.estimate.translation;
    J << -hat(turned), Eigen::Matrix3d::Identity(), Q * each.estimate.R();
    if (level) J.leftCols<2>().setZero();
    const Eigen::Vector3d residual =
        turned + alignment.T_truth_estimate.translation - each.truth.translation;
    normal.information += J.transpose() * J;
    normal.gradient += J.transpose() * residual;
  }
  return normal;
}

/// Inverse on the directions whose eigenvalue exceeds the limit.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix, double limit, int* rank = nullptr) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(matrix.rows());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (eigen.eigenvalues()[i] <= limit) continue;
    inverse[i] = 1.0 / eigen.eigenvalues()[i];
    if (rank != nullptr) ++*rank;
  }
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

LeverArm fit_lever_arm(std::span<const PosePair> pairs, bool level) {
  LeverArm result;
  if (pairs.size() < kFewest) return result;
  const double count = static_cast<double>(pairs.size());
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<PosePair> points = moved(pairs, result.p_body_point);
    const Alignment alignment = level ? align_yaw(points) : align_se3(points);
    const Normal normal = normal_of(points, alignment, level);
    // The frame is eliminated: what remains is what the rotation of the body tells of the lever.
    const Eigen::MatrixXd frame =
        pseudo_inverse(normal.information.topLeftCorner<6, 6>(), 1e-9 * count);
    const Eigen::MatrixXd cross = normal.information.bottomLeftCorner<3, 6>();
    const Eigen::MatrixXd information =
        normal.information.bottomRightCorner<3, 3>() - cross * frame * cross.transpose();
    const Eigen::Vector3d gradient =
        normal.gradient.tail<3>() - cross * frame * normal.gradient.head<6>();
    int observed = 0;
    const Eigen::Vector3d change =
        -pseudo_inverse(information, kSpread * count, &observed) * gradient;
    result.observed = observed;
    result.p_body_point += change;
    if (change.norm() < 1e-9) break;
  }
  return result;
}

Trajectory moved_to_point(Trajectory trajectory, const Eigen::Vector3d& p_body_point) {
  for (StampedPose& each : trajectory) {
    each.pose.translation += each.pose.rotation * p_body_point;
  }
  return trajectory;
}

Trajectory moved_to_points(const Trajectory& trajectory, const Trajectory& points) {
  if (points.empty() || trajectory.empty()) return trajectory;
  Trajectory whole = trajectory;
  for (const StampedPose& each : points) {
    const auto pose = pose_at(trajectory, each.stamp);
    if (pose) whole.push_back({each.stamp, *pose});
  }
  std::ranges::stable_sort(whole, {}, &StampedPose::stamp);
  const auto same = std::ranges::unique(whole, {}, &StampedPose::stamp);
  whole.erase(same.begin(), same.end());
  for (StampedPose& each : whole) {
    const Time inside = std::clamp(each.stamp, points.front().stamp, points.back().stamp);
    each.pose.translation = each.pose * pose_at(points, inside)->translation;
  }
  return whole;
}

}  // namespace aims
