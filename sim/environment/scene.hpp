// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/lie.hpp"

namespace aims {

/// How a surface looks to the LiDAR and to the camera.
struct Material {
  double reflectivity = 0.5;  ///< diffuse, at the LiDAR's wavelength, in [0, 1]
  Eigen::Vector3f color = Eigen::Vector3f(0.75F, 0.75F, 0.72F);  ///< RGB in [0, 1]
};

enum class Shape { kBox, kCylinder };

/// One static body of a scene, in the world frame (z up, floor near z = 0).
struct Solid {
  Shape shape = Shape::kBox;
  Pose T_world_solid;
  /// [m]; of a cylinder along z: radius, radius, half height
  Eigen::Vector3d half_extents = Eigen::Vector3d::Ones();
  Material material;
  bool collides = true;  ///< part of the physics model (kept under about 50 solids)
  bool visible = true;   ///< seen by the LiDAR and the camera
  bool roof = false;     ///< left out of pictures so that the camera looks inside
};

/// Regular grid of floor heights; flat when it has no heights.
struct Floor {
  Eigen::Vector2d min_corner = Eigen::Vector2d(-10.0, -10.0);  ///< [m]
  Eigen::Vector2d max_corner = Eigen::Vector2d(10.0, 10.0);    ///< [m]
  int columns = 0;                                             ///< grid points along x
  int rows = 0;                                                ///< grid points along y
  std::vector<float> heights;  ///< [m], row by row (x runs fastest), at most 0.02 for bumps
  Material material;
};

/// The one description from which physics, ray casting and pictures are built.
struct Scene {
  Floor floor;
  std::vector<Solid> solids;
};

/// True when `point` (world) is inside a solid, or nearer to one than `clearance` [m].
bool is_inside_solid(const Scene& scene, const Eigen::Vector3d& point, double clearance);

}  // namespace aims
