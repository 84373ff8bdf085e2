// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/features/keyframe_map.hpp"
#include "estimator/baselines/pose_graph/loop_closure.hpp"
#include "estimator/baselines/pose_graph/pose_graph.hpp"

namespace aims::pose_graph {

/// The keyframes of a map, whose poses follow a graph with loops between them.
class KeyframeGraph {
 public:
  KeyframeGraph(const PoseGraphConfig& graph, const LoopConfig& loop)
      : graph_(graph), loops_(loop) {}

  /// Adds a keyframe, and the loops found since the last one. True: they may have moved all
  /// keyframes, the new one among them.
  bool add(features::Keyframe keyframe);

  /// Adds a keyframe outside the graph, whose pose stays as it is; for maps without loops.
  void add_fixed(features::Keyframe keyframe) { map_.add(std::move(keyframe)); }

  /// Looks for a loop of the newest keyframe with old ones near a position, when it is time to.
  void search(Time stamp, const Eigen::Vector3d& position) { loops_.search(stamp, position, map_); }

  const features::KeyframeMap& map() const { return map_; }

  /// Loops closed so far.
  int loops() const { return loops_.closed(); }

 private:
  features::KeyframeMap map_;
  PoseGraph graph_;
  LoopClosure loops_;
};

}  // namespace aims::pose_graph
