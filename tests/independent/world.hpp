// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <vector>

#include "tests/independent/relief.hpp"

namespace aims::independent {

using Box = Eigen::AlignedBox3d;

/// A vertical cylinder from floor to ceiling.
struct Pillar {
  double x = 0.0;        ///< of its axis [m]
  double y = 0.0;        ///< of its axis [m]
  double radius = 0.25;  ///< [m]
};

/// A room seen from inside, with recesses in its walls and solids in it.
struct World {
  Box room;
  std::vector<Box> recesses;  ///< air behind openings in the walls at the room's least or largest y
  std::vector<Box> boxes;
  std::vector<Pillar> pillars;
  std::shared_ptr<const Relief> relief = nullptr;  ///< of the room's sides; none: planes
  /// Nothing is farther, or is not looked for [m].
  double reach = std::numeric_limits<double>::infinity();

  /// Distance [m] from `origin`, in the air of the room, along the unit `direction` to the first
  /// surface.
  double distance(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  /// The same room with the solids that a ray of that range from `origin` can reach.
  World within(const Eigen::Vector3d& origin, double range) const;
};

}  // namespace aims::independent
