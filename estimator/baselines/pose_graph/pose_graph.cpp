// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/pose_graph.hpp"

#include <cmath>
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

namespace {

/// Updates with a loop after the first two.
constexpr int kLoopUpdates = 5;

/// Variances of a first pose whose heading and position are free [rad^2, m^2].
constexpr double kLevelVariance = 1e-2;
constexpr double kHeadingVariance = std::numbers::pi * std::numbers::pi;
constexpr double kPositionVariance = 1e8;

Eigen::MatrixXd information(const Eigen::Vector3d& rotation, const Eigen::Vector3d& position) {
  Eigen::VectorXd variances(6);
  variances << rotation, position;
  return sqrt_information_of_sigmas(variances.cwiseSqrt());
}

Eigen::MatrixXd information_between(const PoseGraphConfig& config) {
  return information(Eigen::Vector3d::Constant(config.rotation_variance),
                     {config.position_variance, config.position_variance, config.height_variance});
}

Eigen::MatrixXd information_of_first(const PoseGraphConfig& config) {
  if (config.firm_start) return information_between(config);
  return information({kLevelVariance, kLevelVariance, kHeadingVariance},
                     Eigen::Vector3d::Constant(kPositionVariance));
}

}  // namespace

void describe(Fields& f, PoseGraphConfig& c) {
  f.number("rotation_variance", c.rotation_variance,
           {"rad^2", positive_up_to(1e6), "of the rotation between two keyframes, per axis"});
  f.number("position_variance", c.position_variance,
           {"m^2", positive_up_to(1e6),
            "of the position between two keyframes, along x and y of the LiDAR"});
  f.number("height_variance", c.height_variance,
           {"m^2", positive_up_to(1e6), "of the same, along z of the LiDAR"});
  f.number("relinearize_threshold", c.relinearize_threshold,
           {"rad, m", in_range(1e-6, 1e6),
            "greatest entry of a step from which a pose gets a new linearization point", "iSAM2"});
}

PoseGraph::PoseGraph(const PoseGraphConfig& config)
    : config_(config), graph_(config.relinearize_threshold) {}

bool PoseGraph::add(const Pose& T_map_lidar, const std::vector<Loop>& loops) {
  const int next = graph_.add_variable(T_map_lidar);
  if (next == 0) {
    graph_.add_factor(pose_prior(0, T_map_lidar, information_of_first(config_)));
  } else {
    graph_.add_factor(relative_pose(next - 1, next, poses_.back().inverse() * T_map_lidar,
                                    information_between(config_)));
  }
  for (const Loop& loop : loops) {
    graph_.add_factor(relative_pose(loop.newer, loop.older, loop.T_newer_older,
                                    information(Eigen::Vector3d::Constant(loop.variance),
                                                Eigen::Vector3d::Constant(loop.variance))));
  }
  bool solved = true;
  for (int i = 0; i < (loops.empty() ? 2 : 2 + kLoopUpdates); ++i)
    solved = solved && graph_.update();
  poses_.push_back(T_map_lidar);
  if (!solved) return false;
  poses_.back() = std::get<Pose>(graph_.estimate(next));
  if (loops.empty()) return false;
  for (int i = 0; i < next; ++i) poses_[i] = std::get<Pose>(graph_.estimate(i));
  return true;
}

}  // namespace aims::pose_graph
