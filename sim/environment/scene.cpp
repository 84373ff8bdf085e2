// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/scene.hpp"

#include <algorithm>

namespace aims {

bool is_inside_solid(const Scene& scene, const Eigen::Vector3d& point, double clearance) {
  return std::any_of(scene.solids.begin(), scene.solids.end(), [&](const Solid& solid) {
    const Eigen::Vector3d local = solid.T_world_solid.inverse() * point;
    Eigen::Vector3d outside = local.cwiseAbs() - solid.half_extents;
    if (solid.shape == Shape::kCylinder) {
      outside.x() = local.head<2>().norm() - solid.half_extents.x();
      outside.y() = 0.0;
    }
    const double distance = outside.cwiseMax(0.0).norm();
    return distance < clearance || outside.maxCoeff() <= 0.0;
  });
}

}  // namespace aims
