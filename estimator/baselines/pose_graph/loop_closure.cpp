// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/loop_closure.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/baselines/pose_graph/icp.hpp"

namespace aims::pose_graph {
namespace {

/// Least variance of a loop: a perfect match is no infinite weight.
constexpr double kMinVariance = 1e-12;

/// Points of the keyframes around one, in map axes.
features::FeatureCloud cloud_around(int keyframe, int reach, const features::KeyframeMap& map) {
  std::vector<int> indices;
  const int last = std::min(map.size() - 1, keyframe + reach);
  for (int i = std::max(0, keyframe - reach); i <= last; ++i) indices.push_back(i);
  return map.features(indices);
}

}  // namespace

void describe(Fields& f, LoopConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "close loops", "loopClosureEnableFlag"});
  f.number("interval", c.interval, {"s", in_range(0.0, 1e4), "between two searches"});
  f.number("radius", c.radius,
           {"m", positive_up_to(1e4), "keyframes nearer than this are candidates"});
  f.number("min_age", c.min_age, {"s", up_to(1e6), "age of a candidate"});
  f.integer("keyframes", c.keyframes,
            {"-", in_range(0, 10000), "on both sides of a candidate that make its cloud"});
  f.number("voxel", c.voxel, {"m", in_range(0.01, 10.0), "clouds are averaged in such voxels"});
  f.flag("average_newer", c.average_newer,
         {"", any(), "the newest keyframe's cloud is averaged, too"});
  f.integer("min_newer_points", c.min_newer_points,
            {"-", in_range(0, 1000000), "the newest keyframe needs so many to be aligned"});
  f.integer("min_older_points", c.min_older_points,
            {"-", in_range(0, 1000000), "the cloud around the candidate needs so many"});
  f.number("max_match_distance", c.max_match_distance,
           {"m", in_range(0.01, 1e4), "between a point and its match in the alignment"});
  f.number("max_fitness", c.max_fitness,
           {"m^2", up_to(1e6), "greatest mean squared distance after alignment"});
}

/// The nearest keyframe that is old enough.
std::optional<int> LoopClosure::candidate(Time stamp, const Eigen::Vector3d& position,
                                          const features::KeyframeMap& map) const {
  std::optional<int> best;
  double nearest = config_.radius;
  for (int i = 0; i < map.size(); ++i) {
    const double distance = (map[i].T_map_lidar.translation - position).norm();
    if (to_seconds(stamp - map[i].stamp) <= config_.min_age || distance > nearest) continue;
    if (best && distance == nearest) continue;
    best = i;
    nearest = distance;
  }
  return best;
}

/// The alignment moves the newer keyframe in map axes.
std::optional<Loop> LoopClosure::match(int newer, int older,
                                       const features::KeyframeMap& map) const {
  const features::FeatureCloud newest = cloud_around(newer, 0, map);
  const auto source =
      positions_of(config_.average_newer ? voxel_centroids(newest, config_.voxel) : newest);
  auto target =
      positions_of(voxel_centroids(cloud_around(older, config_.keyframes, map), config_.voxel));
  const auto enough = [](const auto& cloud, int min) {
    return static_cast<int>(cloud.size()) >= min;
  };
  if (!enough(source, config_.min_newer_points) || !enough(target, config_.min_older_points)) {
    return std::nullopt;
  }
  features::PointIndex index;
  index.build(std::move(target));
  const IcpResult found = align(source, index, config_.max_match_distance);
  if (found.iterations == 0 || !(found.fitness <= config_.max_fitness)) return std::nullopt;
  const Pose T_map_newer = found.T_target_source * map[newer].T_map_lidar;
  return Loop{newer, older, T_map_newer.inverse() * map[older].T_map_lidar,
              std::max(found.fitness, kMinVariance)};
}

void LoopClosure::search(Time stamp, const Eigen::Vector3d& position,
                         const features::KeyframeMap& map) {
  if (!config_.enabled || map.empty()) return;
  if (last_search_ && stamp - *last_search_ < from_seconds(config_.interval)) return;
  last_search_ = stamp;
  const int newer = map.size() - 1;
  const std::optional<int> older = candidate(stamp, position, map);
  if (!older || newer == *older || newer == last_closed_) return;
  if (last_pair_ == std::pair(newer, *older)) return;  // matched in vain before
  last_pair_ = {newer, *older};
  const std::optional<Loop> loop = match(newer, *older, map);
  if (!loop) return;
  last_closed_ = newer;
  ++closed_;
  found_.push_back(*loop);
}

}  // namespace aims::pose_graph
