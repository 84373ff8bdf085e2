// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/plane_map.hpp"

#include <cmath>

namespace aims::leg_kilo {
namespace {

/// Bound on the memory of a map; at the published edge these cover 2 km of corridor.
constexpr std::size_t kMaxVoxels = 200000;

Eigen::Array3i voxel_at(const Eigen::Vector3d& point, double edge) {
  return (point.array() / edge).floor().cast<int>();
}

std::uint64_t key_of(const Eigen::Array3i& voxel) {
  return voxel_key({voxel.x(), voxel.y(), voxel.z()});
}

/// The voxel that is searched after that of `point`. As in the published program, coordinates
/// counted in voxels are compared with the centre in metres: at an edge of 0.5 m the neighbour is
/// nearly always the one away from the origin, along all three axes.
Eigen::Array3i neighbour_of(const Eigen::Array3i& voxel, const Eigen::Vector3d& point,
                            const PlaneTree& planes, double edge) {
  Eigen::Array3i neighbour = voxel;
  for (int i = 0; i < 3; ++i) {
    const double counted = point(i) / edge - (point(i) < 0.0 ? 1.0 : 0.0);
    const double quarter = 0.25 * edge;
    if (counted > planes.centre()(i) + quarter) ++neighbour(i);
    if (counted < planes.centre()(i) - quarter) --neighbour(i);
  }
  return neighbour;
}

/// The point against a plane; empty when it is too far from it or from its points.
std::optional<PointOnPlane> on_plane(const ScanPoint& point, const VoxelPlane& plane,
                                     const Residuals& config, double& probability) {
  const Eigen::Vector3d offset = point.in_world - plane.centre;
  const double distance = plane.normal.dot(offset);
  const double along = std::sqrt(offset.squaredNorm() - distance * distance);
  // Written so that a NaN is refused as well.
  if (!(along <= config.max_extent * plane.radius)) return std::nullopt;
  const double of_plane = plane.distance_variance(point.in_world);
  const double variance = of_plane + plane.normal.dot(point.covariance * plane.normal);
  if (!(std::abs(distance) < config.gate * std::sqrt(variance))) return std::nullopt;
  const double density = std::exp(-0.5 * distance * distance / variance) / std::sqrt(variance);
  if (!(density > probability)) return std::nullopt;
  probability = density;
  return PointOnPlane{point.in_body, plane.normal, distance,
                      of_plane + plane.normal.dot(point.beam_covariance * plane.normal)};
}

}  // namespace

std::optional<PointOnPlane> PlaneMap::match_in(const Voxel& voxel, const ScanPoint& point,
                                               const Residuals& config) const {
  std::optional<PointOnPlane> best;
  double probability = 0.0;
  voxel.planes->visit_planes([&](const VoxelPlane& plane) {
    if (const auto match = on_plane(point, plane, config, probability)) best = match;
  });
  return best;
}

std::optional<PointOnPlane> PlaneMap::match(const ScanPoint& point, const Residuals& config) const {
  const Eigen::Array3i at = voxel_at(point.in_world, config_.voxel);
  const Voxel* voxel = voxels_.find(key_of(at));
  if (voxel == nullptr) return std::nullopt;
  if (const auto match = match_in(*voxel, point, config)) return match;
  const Eigen::Array3i next = neighbour_of(at, point.in_world, *voxel->planes, config_.voxel);
  const Voxel* neighbour = voxels_.find(key_of(next));
  if (neighbour == nullptr) return std::nullopt;
  return match_in(*neighbour, point, config);
}

PlaneTree& PlaneMap::planes_at(const Eigen::Vector3d& point) {
  const Eigen::Array3i at = voxel_at(point, config_.voxel);
  Voxel& voxel = voxels_.touch(key_of(at));
  if (!voxel.planes) {
    voxel.planes.emplace(config_.voxel * (at.cast<double>() + 0.5).matrix(), config_.voxel);
  }
  return *voxel.planes;
}

void PlaneMap::build(std::span<const MapPoint> points) {
  voxels_.begin_insertion();
  for (const MapPoint& point : points) planes_at(point.position).collect(point);
  voxels_.visit_touched([this](Voxel& voxel) { voxel.planes->build(config_); });
}

void PlaneMap::add(std::span<const MapPoint> points) {
  for (const MapPoint& point : points) planes_at(point.position).add(point, config_);
}

void PlaneMap::limit(const Eigen::Vector3d& position) {
  voxels_.limit(kMaxVoxels, [&position](const Voxel& voxel) {
    return (voxel.planes->centre() - position).squaredNorm();
  });
}

std::vector<Eigen::Vector3f> PlaneMap::plane_centres() const {
  std::vector<Eigen::Vector3f> centres;
  for (const Voxel& voxel : voxels_) {
    voxel.planes->visit_planes(
        [&centres](const VoxelPlane& plane) { centres.push_back(plane.centre.cast<float>()); });
  }
  return centres;
}

}  // namespace aims::leg_kilo
