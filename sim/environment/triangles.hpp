// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/environment/scene.hpp"

namespace aims {

/// Triangles in the world frame.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;                ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices
};

/// Sides of the prism that stands for a cylinder.
inline constexpr int kCylinderSides = 48;

/// The surface of a solid. A cylinder becomes a prism whose mean radius is the cylinder's.
TriangleMesh triangulate(const Solid& solid);

/// The floor: two triangles, or two per cell of its grid.
TriangleMesh triangulate(const Floor& floor);

}  // namespace aims
