// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/pose_graph.hpp"

#include <cmath>

#include "estimator/baselines/pose_graph/pose_factors.hpp"

namespace aims::pose_graph {
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
