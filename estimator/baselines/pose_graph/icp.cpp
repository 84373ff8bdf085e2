// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/icp.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

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

}  // namespace aims::pose_graph
