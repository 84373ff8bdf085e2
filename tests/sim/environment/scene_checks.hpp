// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/random.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims::testing {

/// Distance to what a ray meets first [m]; infinity: nothing.
inline double distance(const RayCaster& caster, const Eigen::Vector3d& origin,
                       const Eigen::Vector3d& direction) {
  const auto hit = caster.cast(origin, direction.normalized());
  return hit ? hit->distance : std::numeric_limits<double>::infinity();
}

/// Every solid that collides; the physics must stay fast.
inline long colliding_solids(const Scene& scene) {
  return std::count_if(scene.solids.begin(), scene.solids.end(),
                       [](const Solid& solid) { return solid.collides; });
}

/// No ray leaves a closed scene: random ones, and ones aimed at the corners of all solids, from
/// points within it.
inline void expect_no_leak(const Scene& scene, const std::vector<Eigen::Vector3d>& inside,
                           std::uint64_t seed = 7) {
  const RayCaster caster(scene);
  RandomStream random = rng(seed, "leaks");
  for (const Eigen::Vector3d& origin : inside) {
    ASSERT_FALSE(is_inside_solid(scene, origin, 0.0)) << origin.transpose();
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d direction = random.normal3().normalized();
      ASSERT_TRUE(caster.cast(origin, direction))
          << "seed " << seed << ": " << origin.transpose() << " along " << direction.transpose();
    }
    for (const Solid& solid : scene.solids) {
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d signs((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0,
                                    (corner & 4) != 0 ? 1.0 : -1.0);
        const Eigen::Vector3d at =
            solid.T_world_solid * Eigen::Vector3d(signs.cwiseProduct(solid.half_extents));
        // Also between the corners' heights, along the seams of the walls.
        for (const double height : {at.z(), 0.37, 1.9}) {
          const Eigen::Vector3d seam(at.x(), at.y(), height);
          const Eigen::Vector3d direction = (seam - origin).normalized();
          ASSERT_TRUE(caster.cast(origin, direction))
              << origin.transpose() << " towards " << seam.transpose();
        }
      }
    }
  }
}

}  // namespace aims::testing
