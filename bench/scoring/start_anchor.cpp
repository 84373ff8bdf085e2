// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/start_anchor.hpp"

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

}  // namespace aims
