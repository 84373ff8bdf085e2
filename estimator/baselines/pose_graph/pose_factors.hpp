// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/pose_graph/factor_graph.hpp"

namespace aims::pose_graph {

/// The pose is `mean`: r = (Log(R_m^T R), R_m^T (p - p_m)), rotation [rad] before position [m].
Factor pose_prior(int pose, const Pose& mean, const Eigen::MatrixXd& sqrt_information);

/// The second pose relative to the first is `T_from_to`: the residual of a prior on that pose.
Factor relative_pose(int from, int to, const Pose& T_from_to,
                     const Eigen::MatrixXd& sqrt_information);

}  // namespace aims::pose_graph
