// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/error.hpp"
#include "sim/robot/gait.hpp"
#include "sim/robot/route.hpp"
#include "sim/robot/world.hpp"

namespace aims {

/// Position and heading in the plane of the world.
struct Placement {
  double x = 0.0;    ///< [m]
  double y = 0.0;    ///< [m]
  double yaw = 0.0;  ///< [rad]
};

/// A robot that walks a route: dynamics, gait controller and route follower.
class Walker {
 public:
  /// Places the robot at the route's first point, heading to the second, `offset` from there.
  static Result<Walker> create(const WorldSetup& setup, const GaitConfig& gait,
                               const RouteConfig& route, const Placement& offset = {});

  /// Stands until at rest, then calls that time zero.
  void settle();

  /// One physics step.
  void step();

  const World& world() const { return world_; }
  World& world() { return world_; }
  const RouteFollower& route() const { return route_; }
  /// Lying on the floor, or tilted beyond recovery.
  bool fallen() const;

 private:
  Walker(World world, const GaitConfig& gait, const RouteConfig& route, double timestep);

  World world_;
  GaitController gait_;
  RouteFollower route_;
};

}  // namespace aims
