// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/walker.hpp"

#include <utility>

namespace aims {
namespace {

/// Cosine of the tilt beyond which the robot has fallen.
constexpr double kFallenCosine = 0.5;

/// Standing time before time zero, so that the joints are at rest when the recording starts.
constexpr Duration kSettling = 2 * kSecond;

}  // namespace

Walker::Walker(World world, const GaitConfig& gait, const RouteConfig& route, double timestep)
    : world_(std::move(world)), gait_(gait, world_.body(), timestep), route_(route) {}

Result<Walker> Walker::create(const WorldSetup& setup, const GaitConfig& gait,
                              const RouteConfig& route, const Placement& offset) {
  if (auto ok = validate(route); !ok) return tl::unexpected(ok.error());
  auto world = World::create(setup);
  if (!world) return tl::unexpected(world.error());
  world->place(route.points[0].x + offset.x, route.points[0].y + offset.y,
               start_heading(route) + offset.yaw);
  return Walker(std::move(*world), gait, route, setup.timestep);
}

void Walker::settle() {
  while (world_.state().stamp < kSettling) world_.step(gait_.torques(world_.state(), {}));
  world_.restart_clock();
}

void Walker::step() {
  const RobotState& state = world_.state();
  const VelocityCommand command = route_.command(state.stamp, state.T_world_base, gait_.standing(),
                                                 state.velocity.head<2>().norm());
  world_.step(gait_.torques(state, command));
}

bool Walker::fallen() const {
  const RobotState& state = world_.state();
  const double cosine = (state.T_world_base.rotation * Eigen::Vector3d::UnitZ()).z();
  return state.trunk_on_floor || cosine < kFallenCosine;
}

}  // namespace aims
