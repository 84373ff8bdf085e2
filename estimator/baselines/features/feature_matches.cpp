// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/feature_matches.hpp"

#include <cmath>

namespace aims::features {

Pose moved(const Pose& pose, const Vector6& step) {
  return {(so3_exp(step.head<3>()) * pose.rotation).normalized(),
          pose.translation + step.tail<3>()};
}

DistanceRow distance_row(const LineMatch& match, const Pose& pose) {
  const Pose part = part_of(pose, match.fraction);
  DistanceRow row;
  row.arm = part.rotation * match.point;
  const Eigen::Vector3d point = row.arm + part.translation;
  const Eigen::Vector3d from_origin = point - match.origin;
  const Eigen::Vector3d across = from_origin - match.direction * match.direction.dot(from_origin);
  row.distance = across.norm();
  if (row.distance > 0.0) row.gradient = across / row.distance;
  row.range = point.norm();
  return row;
}

DistanceRow distance_row(const PlaneMatch& match, const Pose& pose) {
  const Pose part = part_of(pose, match.fraction);
  DistanceRow row;
  row.arm = part.rotation * match.point;
  const Eigen::Vector3d point = row.arm + part.translation;
  row.distance = match.normal.dot(point) + match.offset;
  row.gradient = match.normal;
  row.range = point.norm();
  return row;
}

void weighted_distances(const FeatureMatches& matches, const Pose& pose,
                        const DistanceWeight& weighting, const TakeDistance& take) {
  const auto offer = [&](const Eigen::Vector3d& point, const DistanceRow& row, double scale) {
    const double weight = 1.0 - weighting.slope * std::abs(row.distance) / scale;
    if (weight > weighting.least && row.distance != 0.0) take(point, row, weight);
  };
  for (const LineMatch& match : matches.lines) {
    offer(match.point, distance_row(match, pose), 1.0);
  }
  for (const PlaneMatch& match : matches.planes) {
    const DistanceRow row = distance_row(match, pose);
    offer(match.point, row, std::sqrt(row.range));
  }
}

}  // namespace aims::features
