// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/lie.hpp"
#include "core/time.hpp"
#include "sim/environment/building_config.hpp"

namespace aims {

/// Appearance of a surface to the LiDAR and to the camera.
struct Material {
  double reflectivity = 0.5;  ///< diffuse, at the LiDAR's wavelength, in [0, 1]
  Eigen::Vector3f color = Eigen::Vector3f(0.75F, 0.75F, 0.72F);  ///< RGB in [0, 1]
  /// Glass: smallest cosine of incidence that returns a beam; 0: opaque.
  double return_cosine = 0.0;
};

enum class Shape { kBox, kCylinder };

/// One static body of a scene, in the world frame (z up, floor near z = 0).
struct Solid {
  Shape shape = Shape::kBox;
  Pose T_world_solid;
  /// [m]; of a cylinder along z: radius, radius, half height
  Eigen::Vector3d half_extents = Eigen::Vector3d::Ones();
  Material material;
  bool collides = true;  ///< part of the physics model (at most about 50 solids)
  bool visible = true;   ///< to the LiDAR and the camera
  bool roof = false;     ///< left out of pictures so that the camera looks inside
};

/// Regular grid of floor heights; flat when it has no heights.
struct Floor {
  Eigen::Vector2d min_corner = Eigen::Vector2d(-10.0, -10.0);  ///< [m]
  Eigen::Vector2d max_corner = Eigen::Vector2d(10.0, 10.0);    ///< [m]
  int columns = 0;                                             ///< grid points along x
  int rows = 0;                                                ///< grid points along y
  std::vector<float> heights;  ///< [m], at least 0, row by row (x runs fastest)
  Material material;
};

/// A person who walks up and down between two points at constant speed, along a line or an arc, as
/// an upright cylinder. Visible to the LiDAR and the camera, but without collisions.
struct Person {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< turning point [m]
  Eigen::Vector2d to = Eigen::Vector2d::UnitX();   ///< the other one [m]
  double turn = 0.0;     ///< from one to the other on an arc, positive to the left [rad]; 0: a line
  double ground = 0.0;   ///< height of the level floor that the person walks on [m]
  double speed = 1.0;    ///< [m/s]
  double start = 0.0;    ///< distance walked at time zero, in [0, twice the distance) [m]
  double radius = 0.25;  ///< [m]
  double height = 1.75;  ///< [m]
  Material material;

  /// Between the turning points, along the line or the arc [m].
  double distance() const;
  /// Of the axis at a time of the simulation [m]; closed form.
  Eigen::Vector2d position(Time stamp) const;
};

/// Height [m] of the floor's surface (two triangles per cell, as in every product); beyond the
/// floor's border, of the nearest point on it.
double floor_height(const Floor& floor, double x, double y);

/// The one description from which physics, ray casting and pictures are built.
struct Scene {
  Floor floor;
  std::vector<Solid> solids;
  std::vector<Person> people;
  SurfaceConfig surface;           ///< as the LiDAR sees solids and floor
  std::uint64_t surface_seed = 0;  ///< of its fields
};

/// The scene as it looks at one instant, for pictures: people become solids.
Scene scene_at(const Scene& scene, Time stamp);

/// True when `point` (world) is inside a solid, or nearer to one than `clearance` [m].
bool is_inside_solid(const Scene& scene, const Eigen::Vector3d& point, double clearance);

}  // namespace aims
