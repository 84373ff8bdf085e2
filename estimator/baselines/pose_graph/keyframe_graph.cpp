// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/keyframe_graph.hpp"

#include <utility>

namespace aims::pose_graph {

bool KeyframeGraph::add(features::Keyframe keyframe) {
  const bool moved = graph_.add(keyframe.T_map_lidar, loops_.take_found());
  keyframe.T_map_lidar = graph_.pose(map_.size());
  map_.add(std::move(keyframe));
  if (!moved) return false;
  for (int i = 0; i < map_.size(); ++i) map_.set_pose(i, graph_.pose(i));
  return true;
}

}  // namespace aims::pose_graph
