// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/loop_closure.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/baselines/lio_sam/icp.hpp"

namespace aims::lio_sam {
namespace {

/// Fewer points are not aligned.
constexpr std::size_t kMinNewerPoints = 300;
constexpr std::size_t kMinOlderPoints = 1000;

/// Least variance of a loop: a perfect match is no infinite weight.
constexpr double kMinVariance = 1e-12;

/// Points of the keyframes around one, in map axes.
std::vector<Eigen::Vector3f> cloud_around(int keyframe, int reach, double voxel,
                                          const features::KeyframeMap& map) {
  std::vector<int> indices;
  const int last = std::min(map.size() - 1, keyframe + reach);
  for (int i = std::max(0, keyframe - reach); i <= last; ++i) indices.push_back(i);
  features::KeyframeMap::Submap submap = map.submap(indices);
  features::FeatureCloud& all = submap.edges;
  all.insert(all.end(), submap.planes.begin(), submap.planes.end());
  return positions_of(voxel_centroids(all, voxel));
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
  f.number("max_fitness", c.max_fitness,
           {"m^2", up_to(1e6), "greatest mean squared distance after alignment"});
}

/// The nearest keyframe that is old enough.
std::optional<int> LoopClosure::candidate(Time stamp, const features::KeyframeMap& map) const {
  std::optional<int> best;
  double nearest = config_.radius;
  for (int i = 0; i < map.size(); ++i) {
    const double distance = (map[i].T_map_lidar.translation - map.last_pose().translation).norm();
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
  const auto source = cloud_around(newer, 0, config_.voxel, map);
  auto target = cloud_around(older, config_.keyframes, config_.voxel, map);
  if (source.size() < kMinNewerPoints || target.size() < kMinOlderPoints) return std::nullopt;
  features::PointIndex index;
  index.build(std::move(target));
  const IcpResult found = align(source, index, 2.0 * config_.radius);
  if (found.iterations == 0 || !(found.fitness <= config_.max_fitness)) return std::nullopt;
  const Pose T_map_newer = found.T_target_source * map[newer].T_map_lidar;
  return Loop{newer, older, T_map_newer.inverse() * map[older].T_map_lidar,
              std::max(found.fitness, kMinVariance)};
}

void LoopClosure::search(Time stamp, const features::KeyframeMap& map) {
  if (!config_.enabled || map.empty()) return;
  if (last_search_ && stamp - *last_search_ < from_seconds(config_.interval)) return;
  last_search_ = stamp;
  const int newer = map.size() - 1;
  const std::optional<int> older = candidate(stamp, map);
  if (!older || newer == *older || newer == last_closed_) return;
  if (last_pair_ == std::pair(newer, *older)) return;  // matched in vain before
  last_pair_ = {newer, *older};
  const std::optional<Loop> loop = match(newer, *older, map);
  if (!loop) return;
  last_closed_ = newer;
  ++closed_;
  found_.push_back(*loop);
}

}  // namespace aims::lio_sam
