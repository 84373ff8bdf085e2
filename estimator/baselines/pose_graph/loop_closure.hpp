// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/config.hpp"
#include "core/time.hpp"
#include "estimator/baselines/features/keyframe_map.hpp"
#include "estimator/baselines/pose_graph/pose_graph.hpp"

namespace aims::pose_graph {

/// Loops by distance (LIO-SAM, section III-E); defaults of its published program.
struct LoopConfig {
  bool enabled = true;
  double interval = 1.0;             ///< between two searches [s]
  double radius = 15.0;              ///< keyframes nearer than this are candidates [m]
  double min_age = 30.0;             ///< and older than this [s]
  int keyframes = 25;                ///< on both sides of a candidate that make its cloud
  double voxel = 0.4;                ///< clouds are averaged in voxels of it [m]
  bool average_newer = true;         ///< the newest keyframe's cloud, too
  int min_newer_points = 300;        ///< smaller clouds are not aligned
  int min_older_points = 1000;       ///< likewise, around the candidate
  double max_match_distance = 30.0;  ///< between a point and its match [m]
  double max_fitness = 0.3;          ///< greatest mean squared distance after alignment [m^2]
};

void describe(Fields& fields, LoopConfig& config);

/// Looks for loops between the newest keyframe and old ones near it.
class LoopClosure {
 public:
  explicit LoopClosure(const LoopConfig& config) : config_(config) {}

  /// Searches around a position when it is time to.
  void search(Time stamp, const Eigen::Vector3d& position, const features::KeyframeMap& map);

  /// The loops found since the last call.
  std::vector<Loop> take_found() { return std::exchange(found_, {}); }

  /// Loops found so far.
  int closed() const { return closed_; }

 private:
  std::optional<int> candidate(Time stamp, const Eigen::Vector3d& position,
                               const features::KeyframeMap& map) const;
  std::optional<Loop> match(int newer, int older, const features::KeyframeMap& map) const;

  LoopConfig config_;
  std::optional<Time> last_search_;
  std::pair<int, int> last_pair_ = {-1, -1};
  int last_closed_ = -1;  ///< keyframe that has a loop
  int closed_ = 0;
  std::vector<Loop> found_;
};

}  // namespace aims::pose_graph
