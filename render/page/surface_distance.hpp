// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>

#include "sim/environment/scene.hpp"

namespace aims {

/// Distances from points to the surface of a scene: its visible solids and its floor, as the LiDAR
/// sees them. People are left out. Exact for the triangles; safe to ask from several threads.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const Scene& scene);
  SurfaceDistance(SurfaceDistance&&) noexcept;
  SurfaceDistance& operator=(SurfaceDistance&&) noexcept;
  ~SurfaceDistance();

  /// Distance [m] from a point of the world to the nearest surface, or `limit` [m] when none is
  /// nearer.
  float operator()(const Eigen::Vector3f& p_world, float limit) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Squared distance [m^2] from `p` to the triangle `a`, `b`, `c`.
float squared_distance(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                       const Eigen::Vector3f& c);

}  // namespace aims
