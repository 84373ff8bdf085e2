// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/weak/weak_direction.hpp"

namespace aims {
namespace {

using Eigen::Vector3f;

constexpr float kAbove = 0.2F;  ///< of the surface, from where the texture is read [m]
constexpr float kStep = 0.02F;  ///< to either side [m]
constexpr int kRaysPerHit = 4;  ///< both sides along two directions
constexpr float kLeastIntensity = 1e-3F;

/// Two unit vectors across a unit normal.
std::pair<Vector3f, Vector3f> across(const Vector3f& normal) {
  const Vector3f first = normal.unitOrthogonal();
  return {first, normal.cross(first)};
}

/// Gradient of the logarithm of the reflectivity at a hit [1/m]; zero beside an edge.
Vector3f texture_gradient(const RayCaster& caster, const Vector3f& point, const Vector3f& normal,
                          int surface) {
  const auto [first, second] = across(normal);
  RayPacket rays;
  for (int i = 0; i < kRaysPerHit; ++i) {
    const Vector3f side = (i < 2 ? first : second) * (i % 2 == 0 ? kStep : -kStep);
    const Vector3f from = point + kAbove * normal + side;
    rays.origin_x[i] = from.x();
    rays.origin_y[i] = from.y();
    rays.origin_z[i] = from.z();
    rays.direction_x[i] = -normal.x();
    rays.direction_y[i] = -normal.y();
    rays.direction_z[i] = -normal.z();
  }
  HitPacket hits;
  caster.cast(rays, 2.0F * kAbove, hits, kRaysPerHit);
  for (int i = 0; i < kRaysPerHit; ++i) {
    if (hits.surface[i] != surface) return Vector3f::Zero();
  }
  const auto slope = [&hits](int i) {
    return std::log(hits.texture[i] / hits.texture[i + 1]) / (2.0F * kStep);
  };
  return slope(0) * first + slope(2) * second;
}

}  // namespace

ScanTruth intensity_rows(const RayCaster& caster, const LidarConfig& config, const LidarScan& scan,
                         const ScanTruth& hits, const Eigen::Vector3d& p_world_lidar) {
  ScanTruth rows = hits;
  rows.cosines.assign(hits.points.size(), 1.0F);
  rows.range_sigmas.assign(hits.points.size(), std::numeric_limits<float>::infinity());
  if (!caster.has_relief()) return rows;
  const double step = config.intensity_resolution / std::sqrt(12.0);
  for (std::size_t i = 0; i < hits.points.size(); ++i) {
    const Vector3f& normal = hits.normals[i];
    const Vector3f direction = (hits.points[i] - p_world_lidar.cast<float>()).normalized();
    const float along = normal.dot(direction);
    const bool at_edge = !hits.range_sigmas.empty() && std::isinf(hits.range_sigmas[i]);
    if (at_edge || along > -0.01F || hits.surfaces[i] >= caster.first_moving_surface()) continue;
    const Vector3f gradient = texture_gradient(caster, hits.points[i], normal, hits.surfaces[i]);
    rows.normals[i] = gradient - normal * (gradient.dot(direction) / along);
    const double intensity = std::max(scan.points[i].intensity, kLeastIntensity);
    rows.range_sigmas[i] = static_cast<float>(std::hypot(config.intensity_sigma, step / intensity));
  }
  return rows;
}

}  // namespace aims
