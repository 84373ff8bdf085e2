// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>
#include <vector>

#include "core/config.hpp"
#include "estimator/baselines/pose_graph/factor_graph.hpp"

namespace aims::pose_graph {

/// The pose is `mean`: r = (Log(R_m^T R), R_m^T (p - p_m)), rotation [rad] before position [m].
Factor pose_prior(int pose, const Pose& mean, const Eigen::MatrixXd& sqrt_information);

/// The second pose relative to the first is `T_from_to`: the residual of a prior on that pose.
Factor relative_pose(int from, int to, const Pose& T_from_to,
                     const Eigen::MatrixXd& sqrt_information);

/// Graph of keyframes (LIO-SAM, section III); defaults of its published program.
struct PoseGraphConfig {
  double rotation_variance = 1e-6;     ///< between two keyframes [rad^2]
  double position_variance = 1e-4;     ///< along x and y of the LiDAR [m^2]
  double height_variance = 1e-4;       ///< along z of the LiDAR [m^2]
  double relinearize_threshold = 0.1;  ///< see FactorGraph [rad, m]
  /// The first pose has these variances, too; else it is nearly free. No setting: the choice moves
  /// no keyframe relative to another, but a free pose beside small variances has no solution in
  /// double precision.
  bool firm_start = false;
};

void describe(Fields& fields, PoseGraphConfig& config);

/// A keyframe seen again: where the newer one was when it was matched with the older one.
struct Loop {
  int newer = 0;
  int older = 0;
  Pose T_newer_older;
  double variance = 0.0;  ///< of each entry of its residual [rad^2, m^2]
};

/// Poses of keyframes, one after the other, and loops between them.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphConfig& config);

  /// Adds the next keyframe, which moved from the last one as the two poses differ, and loops
  /// between earlier ones. Whether the other poses may have changed.
  bool add(const Pose& T_map_lidar, const std::vector<Loop>& loops);

  /// Of a keyframe.
  const Pose& pose(int keyframe) const { return poses_[keyframe]; }

 private:
  PoseGraphConfig config_;
  FactorGraph graph_;
  std::vector<Pose> poses_;
};

}  // namespace aims::pose_graph
