// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/start_anchor.hpp"

#include <cmath>
#include <utility>

#include "bench/metrics/alignment.hpp"
#include "bench/metrics/association.hpp"

namespace aims {

Pose start_anchor(const Trajectory& estimate, const Trajectory& truth, const ScoreConfig& scoring) {
  const ValidPart valid(estimate);
  const auto pairs = compared_pairs(valid.poses(), truth, scoring);
  return align_start(pairs, start_alignment(scoring)).T_truth_estimate;
}

Trajectory anchored(const Trajectory& estimate, const Trajectory& truth,
                    const ScoreConfig& scoring) {
  const Pose T_world_odom = start_anchor(estimate, truth, scoring);
  Trajectory result = valid_part(estimate);
  for (StampedPose& each : result) each.pose = T_world_odom * each.pose;
  return result;
}

Trajectory heading_fitted(Trajectory anchored, const Trajectory& truth, const ScoreConfig& scoring,
                          std::optional<Time> failed) {
  const auto pairs = compared_pairs(anchored, truth, scoring);
  if (pairs.empty()) return anchored;
  const Pose& estimate = pairs.front().estimate;
  const Pose& start = pairs.front().truth;
  double sine = 0.0;
  double cosine = 0.0;
  for (const PosePair& pair : pairs) {
    if (failed && pair.stamp > *failed) break;
    const Eigen::Vector3d from = pair.estimate.translation - estimate.translation;
    const Eigen::Vector3d to = pair.truth.translation - start.translation;
    sine += from.x() * to.y() - from.y() * to.x();
    cosine += from.x() * to.x() + from.y() * to.y();
  }
  const Eigen::Quaterniond turn = yaw_rotation(std::atan2(sine, cosine));
  for (StampedPose& each : anchored) {
    each.pose.translation =
        estimate.translation + turn * (each.pose.translation - estimate.translation);
    each.pose.rotation = turn * each.pose.rotation;
  }
  return anchored;
}

}  // namespace aims
