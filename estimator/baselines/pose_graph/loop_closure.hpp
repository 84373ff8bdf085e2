// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "core/config.hpp"
#include "core/lie.hpp"
#include "core/time.hpp"
#include "estimator/baselines/features/feature_map.hpp"
#include "estimator/baselines/features/feature_matches.hpp"
#include "estimator/baselines/pose_graph/pose_graph.hpp"

namespace aims::pose_graph {

/// What the alignment of two clouds found.
struct IcpResult {
  Pose T_target_source;
  double fitness = 0.0;  ///< mean squared distance of the source's points from the target [m^2]
  int iterations = 0;    ///< 0: too few points in reach
};

/// Aligns a cloud with another by iterated closest points (Besl and McKay 1992), with the rules of
/// the Point Cloud Library for an end: a step below 1 mm and 1.4 mrad, or a mean squared distance
/// that changes by less than 1e-6 m^2 or a part of 1e-5. Points farther than `max_distance` [m] are
/// left out. Both clouds have the same axes.
IcpResult align(const std::vector<Eigen::Vector3f>& source, const features::PointIndex& target,
                double max_distance);

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
