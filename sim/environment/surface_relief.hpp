// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/random.hpp"
#include "sim/environment/building_config.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// A random field on the plane that repeats after kColumns cells along u and kRows along v,
/// bilinear between the nodes of a grid.
class PeriodicField {
 public:
  static constexpr float kCell = 0.04F;  ///< [m]
  static constexpr int kColumns = 2048;
  static constexpr int kRows = 256;

  /// Value and slopes of the field at a point.
  struct Sample {
    float value = 0.0F;
    float slope_u = 0.0F;  ///< [1/m]
    float slope_v = 0.0F;  ///< [1/m]
  };

  /// Zero mean, the given standard deviation.
  PeriodicField(double deviation, double shortest, double longest, RandomStream random);

  /// At (u, v) [m].
  Sample at(float u, float v) const;

 private:
  std::vector<float> nodes_;  ///< row by row; none: 0 everywhere
};

/// Displaces rays' hits on the boxes and the floor of a scene by the relief of their surfaces, to
/// first order along each ray; cylinders, glass and people stay as they are. Reliefs of
/// neighbouring solids are independent. Nothing else sees it: the feet walk on planes, and pictures
/// show them.
class SurfaceRelief {
 public:
  /// A hit on the smooth surface, to be moved.
  struct Hit {
    Eigen::Vector3f point;      ///< in the world [m]
    Eigen::Vector3f direction;  ///< of the ray, unit
    Eigen::Vector3f normal;     ///< unit, towards the ray's origin
    int surface = 0;            ///< index of the solid; the number of solids is the floor
  };
  /// What the relief makes of it.
  struct Moved {
    float farther = 0.0F;                               ///< along the ray [m]
    Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit, towards the ray's origin
    float reflectivity = 1.0F;                          ///< factor
  };

  SurfaceRelief(const SurfaceConfig& config, const Scene& scene, std::uint64_t seed);

  Moved moved(const Hit& hit) const;

 private:
  /// Axes of a box and where its faces are cut out of the fields.
  struct Face {
    Eigen::Vector3f u;      ///< unit, world
    Eigen::Vector3f v;      ///< unit, world
    float offset_u = 0.0F;  ///< [m]
    float offset_v = 0.0F;  ///< [m]
  };
  struct Box {
    bool smooth = true;
    Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns: normals of the faces
    std::array<Face, 3> faces;                           ///< by normal
  };

  const Face& face_of(const Box& box, const Eigen::Vector3f& normal) const;

  PeriodicField heights_;
  PeriodicField texture_;
  std::vector<Box> boxes_;  ///< by surface
};

}  // namespace aims
