// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/loop_closure.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace aims::pose_graph {

namespace {

constexpr int kMaxIterations = 100;
constexpr double kTransformEpsilon = 1e-6;     ///< squared step [m^2], and 1 - cos of its angle
constexpr double kSquaredErrorEpsilon = 1e-6;  ///< change of the mean squared distance [m^2]
constexpr double kRelativeEpsilon = 1e-5;      ///< the same, over the last one
constexpr Eigen::Index kMinPairs = 3;

/// Points of the source and the nearest of the target.
struct Pairs {
  Eigen::Matrix3Xd source;
  Eigen::Matrix3Xd target;
  double mean_square = 0.0;  ///< distance [m^2]
};

Pairs nearest_pairs(const std::vector<Eigen::Vector3f>& source, const Pose& pose,
                    const features::PointIndex& target, double max_distance) {
  Pairs pairs;
  pairs.source.resize(3, static_cast<Eigen::Index>(source.size()));
  pairs.target.resize(3, static_cast<Eigen::Index>(source.size()));
  Eigen::Index count = 0;
  for (const Eigen::Vector3f& point : source) {
    const Eigen::Vector3d moved = pose * point.cast<double>();
    std::array<features::Neighbor, 1> found;
    if (target.nearest(moved.cast<float>(), found) == 0) continue;
    const double squared = found[0].squared_distance;
    if (squared > max_distance * max_distance) continue;
    pairs.source.col(count) = moved;
    pairs.target.col(count) = target.points()[found[0].index].cast<double>();
    pairs.mean_square += squared;
    ++count;
  }
  pairs.source.conservativeResize(Eigen::NoChange, count);
  pairs.target.conservativeResize(Eigen::NoChange, count);
  pairs.mean_square /= static_cast<double>(std::max<Eigen::Index>(count, 1));
  return pairs;
}

Pose rigid_motion(const Pairs& pairs) {
  const Eigen::Matrix4d T = Eigen::umeyama(pairs.source, pairs.target, false);
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  return {Eigen::Quaterniond(R).normalized(), T.topRightCorner<3, 1>()};
}

bool is_small(const Pose& step) {
  const double angle = so3_log(step.rotation).norm();
  return std::cos(angle) >= 1.0 - kTransformEpsilon &&
         step.translation.squaredNorm() <= kTransformEpsilon;
}

bool is_steady(double mean_square, double last) {
  const double change = std::abs(mean_square - last);
  return change < kSquaredErrorEpsilon || change < kRelativeEpsilon * last;
}

}  // namespace

IcpResult align(const std::vector<Eigen::Vector3f>& source, const features::PointIndex& target,
                double max_distance) {
  IcpResult result;
  double last = std::numeric_limits<double>::infinity();
  while (result.iterations < kMaxIterations) {
    const Pairs pairs = nearest_pairs(source, result.T_target_source, target, max_distance);
    if (pairs.source.cols() < kMinPairs) break;
    const Pose step = rigid_motion(pairs);
    result.T_target_source = step * result.T_target_source;
    ++result.iterations;
    if (is_small(step) || is_steady(pairs.mean_square, last)) break;
    last = pairs.mean_square;
  }
  result.T_target_source.rotation.normalize();
  result.fitness =
      nearest_pairs(source, result.T_target_source, target, std::numeric_limits<double>::infinity())
          .mean_square;
  return result;
}

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

bool KeyframeGraph::add(features::Keyframe keyframe) {
  const bool moved = graph_.add(keyframe.T_map_lidar, loops_.take_found());
  keyframe.T_map_lidar = graph_.pose(map_.size());
  map_.add(std::move(keyframe));
  if (!moved) return false;
  for (int i = 0; i < map_.size(); ++i) map_.set_pose(i, graph_.pose(i));
  return true;
}

}  // namespace aims::pose_graph
