// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/error.hpp"
#include "sim/gait.hpp"
#include "sim/route.hpp"
#include "sim/world.hpp"

namespace aims {

/// A robot in a world that walks its route by itself: dynamics, gait and route follower.
class Walker {
 public:
  /// Places the robot at the route's first point, heading to the second.
  static Result<Walker> create(const WorldSetup& setup, const GaitConfig& gait,
                               const RouteConfig& route);

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
