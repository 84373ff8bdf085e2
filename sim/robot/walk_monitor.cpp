// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/walk_monitor.hpp"

#include <numbers>

namespace aims {
namespace {

constexpr double kProgressStep = 1.0;  ///< towards the next point that counts as progress [m]
constexpr double kRestingTime = 2.0;   ///< that coming to rest at a point takes [s]
constexpr double kPatience = 5.0;      ///< in multiples of the expected time [-]

bool is_outside(const Floor& floor, const Eigen::Vector3d& position) {
  const Eigen::Vector2d at = position.head<2>();
  const bool beyond = (at.array() < floor.min_corner.array()).any() ||
                      (at.array() > floor.max_corner.array()).any();
  return beyond || position.z() < floor_height(floor, at.x(), at.y());
}

}  // namespace

double patience(const RouteConfig& route) {
  const double turn = std::numbers::pi / route.turn_rate;
  return kPatience * (turn + kProgressStep / route.speed + kRestingTime);
}

WalkMonitor::WalkMonitor(const RouteConfig& route, double stride, double max_duration)
    : patience_(from_seconds(patience(route))),
      stride_(from_seconds(stride)),
      limit_(from_seconds(max_duration)) {}

void WalkMonitor::update(const Walker& walker, const Floor& floor) {
  if (ended()) return;
  watch_contact(walker);
  outcome_.end = end_of(walker, floor);
  last_ = walker.world().state().stamp;
}

WalkEnd WalkMonitor::end_of(const Walker& walker, const Floor& floor) {
  const RobotState& state = walker.world().state();
  if (walker.world().warning_count() > 0) return WalkEnd::kUnstablePhysics;
  if (is_outside(floor, state.T_world_base.translation)) return WalkEnd::kLeftScene;
  if (walker.fallen()) return WalkEnd::kFell;
  if (walker.route().done()) return WalkEnd::kRouteDone;
  if (is_stuck(walker)) return WalkEnd::kNoProgress;
  return state.stamp >= limit_ ? WalkEnd::kTimeLimit : WalkEnd::kRunning;
}

/// Whether the distance to the next point has not shrunk by a step for too long. A push that throws
/// the robot back leaves it all that time to return.
bool WalkMonitor::is_stuck(const Walker& walker) {
  const RouteFollower& route = walker.route();
  const Time now = walker.world().state().stamp;
  const double distance = route.distance_left(walker.world().state().T_world_base);
  const bool progress = !route.under_way() || route.next_point() != next_point_ ||
                        distance < nearest_ - kProgressStep;
  if (progress) {
    next_point_ = route.next_point();
    nearest_ = distance;
    progress_ = now;
  }
  return now - progress_ > patience_;
}

void WalkMonitor::watch_contact(const Walker& walker) {
  const RobotState& state = walker.world().state();
  if (state.touches_wall) {
    outcome_.touched_wall = true;
    contact_until_ = state.stamp + stride_;
  }
  if (!walker.route().under_way()) return;
  const Duration step = state.stamp - last_;
  under_way_ += step;
  if (state.stamp < contact_until_) in_contact_ += step;
  if (under_way_ > 0)
    outcome_.wall_contact_fraction = to_seconds(in_contact_) / to_seconds(under_way_);
}

}  // namespace aims
