// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/drift_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace aims {
namespace {

/// Distance between the places where planes are searched, and of a plane from such a place [m].
constexpr double kSearchStep = 0.2;
/// Offsets that agree differ by less: noise of returns and planes, and the heading over 30 m [m].
constexpr double kConsensusWidth = 0.15;
/// Smallest cosine between the normal of a plane that faces along the axis and the axis.
constexpr double kMinCosine = 0.7;

/// The offset along `axis` at which `point` (odometry frame) lies on the nearest plane that faces
/// along it.
std::optional<double> offset_onto_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                                        double reach, const VoxelMap& map) {
  std::optional<double> nearest;
  for (double searched = -reach; searched <= reach; searched += kSearchStep) {
    const Eigen::Vector3d query = point + searched * axis;
    const PlanePair planes = map.planes_at(query.cast<float>());
    if (!planes.valid()) continue;
    if (!faces_along(planes.a, axis)) continue;
    const double further = -planes.a.distance(query) / planes.a.normal.dot(axis);
    const double offset = searched + further;
    if (std::abs(further) > kSearchStep || std::abs(offset) > reach) continue;
    if (!nearest || std::abs(offset) < std::abs(*nearest)) nearest = offset;
  }
  return nearest;
}

}  // namespace

bool faces_along(const Plane& plane, const Eigen::Vector3d& axis) {
  return std::abs(plane.normal.dot(axis)) >= kMinCosine;
}

std::optional<double> offset_by_consensus(std::span<const Eigen::Vector3d> points,
                                          const Pose& T_odom_body, const Eigen::Vector3d& axis,
                                          double reach, const VoxelMap& map) {
  std::vector<double> offsets;
  for (const Eigen::Vector3d& point : points) {
    const auto offset = offset_onto_plane(T_odom_body * point, axis, reach, map);
    if (offset) offsets.push_back(*offset);
  }
  std::ranges::sort(offsets);
  auto first = offsets.begin();  // of the offsets that agree with `last`
  auto begin = offsets.begin();
  auto end = offsets.begin();
  for (auto last = offsets.begin(); last != offsets.end(); ++last) {
    while (*last - *first > kConsensusWidth) ++first;
    if (last + 1 - first > end - begin) {
      begin = first;
      end = last + 1;
    }
  }
  const auto agreeing = end - begin;
  if (agreeing < kMinConsensus) return std::nullopt;
  return std::accumulate(begin, end, 0.0) / static_cast<double>(agreeing);
}

}  // namespace aims
