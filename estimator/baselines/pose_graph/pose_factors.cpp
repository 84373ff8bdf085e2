// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/pose_factors.hpp"

#include <utility>

namespace aims::pose_graph {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;

/// Difference of two poses, as a prior has it, and its derivative in a step of `pose`.
Linearization pose_difference(const Pose& pose, const Pose& mean) {
  const Eigen::Quaterniond turn = mean.rotation.conjugate() * pose.rotation;
  const Eigen::Vector3d angle = so3_log(turn);
  Linearization result;
  result.residual.resize(6);
  result.residual << angle, mean.rotation.conjugate() * (pose.translation - mean.translation);
  MatrixXd jacobian = MatrixXd::Zero(6, 6);
  jacobian.topLeftCorner<3, 3>() = so3_right_jacobian_inverse(angle);
  jacobian.bottomRightCorner<3, 3>() = turn.toRotationMatrix();
  result.jacobians = {std::move(jacobian)};
  return result;
}

/// Derivative of T_from_to in a step of `from`, as a step of T_from_to.
MatrixXd by_step_of_origin(const Pose& T_from_to) {
  const Matrix3d R_to_from = T_from_to.R().transpose();
  MatrixXd jacobian = MatrixXd::Zero(6, 6);
  jacobian.topLeftCorner<3, 3>() = -R_to_from;
  jacobian.bottomLeftCorner<3, 3>() = R_to_from * hat(T_from_to.translation);
  jacobian.bottomRightCorner<3, 3>() = -R_to_from;
  return jacobian;
}

}  // namespace

Factor pose_prior(int pose, const Pose& mean, const MatrixXd& sqrt_information) {
  return {{pose}, sqrt_information, [mean](std::span<const Value> values) {
            return pose_difference(std::get<Pose>(values[0]), mean);
          }};
}

Factor relative_pose(int from, int to, const Pose& T_from_to, const MatrixXd& sqrt_information) {
  return {{from, to}, sqrt_information, [T_from_to](std::span<const Value> values) {
            const Pose relative = std::get<Pose>(values[0]).inverse() * std::get<Pose>(values[1]);
            Linearization result = pose_difference(relative, T_from_to);
            result.jacobians.insert(result.jacobians.begin(),
                                    result.jacobians[0] * by_step_of_origin(relative));
            return result;
          }};
}

}  // namespace aims::pose_graph
