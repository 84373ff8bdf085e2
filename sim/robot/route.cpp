// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/route.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aims {
namespace {

constexpr double kStopDistance = 0.02;  ///< [m]
constexpr double kDeceleration = 0.4;   ///< of the approach to a stop [m/s^2]
constexpr double kCreep = 0.1;          ///< slowest approach [m/s]
constexpr double kTurnGain = 2.0;       ///< [1/s]
constexpr double kSlowestTurn = 0.25;   ///< [rad/s]
constexpr double kAligned = 0.05;       ///< heading error that ends a turn in place [rad]
constexpr double kAmbiguousTurn =
    2.6;                             ///< error beyond which either turning direction will do [rad]
constexpr double kRestSpeed = 0.03;  ///< [m/s]
constexpr Duration kRestTime = 300 * kMillisecond;

double heading_of(const Eigen::Vector2d& direction) {
  return std::atan2(direction.y(), direction.x());
}

Eigen::Vector2d step_between(const RoutePoint& a, const RoutePoint& b) {
  return {b.x - a.x, b.y - a.y};
}

}  // namespace

Result<void> validate(const RouteConfig& route) {
  if (route.points.size() < 2) {
    return failure("route.points: expected at least two points, got " +
                   std::to_string(route.points.size()));
  }
  for (std::size_t i = 1; i < route.points.size(); ++i) {
    if (step_between(route.points[i - 1], route.points[i]).norm() < 0.1) {
      return failure("route.points." + std::to_string(i) +
                     ": expected at least 0.1 m from the point before");
    }
  }
  return {};
}

double start_heading(const RouteConfig& route) {
  return wrap_angle(heading_of(step_between(route.points[0], route.points[1])) - route.sideslip);
}

double nominal_duration(const RouteConfig& route) {
  double duration = route.stand_before + route.stand_after;
  double heading = start_heading(route) + route.sideslip;
  for (std::size_t i = 1; i < route.points.size(); ++i) {
    const Eigen::Vector2d step = step_between(route.points[i - 1], route.points[i]);
    const double turn = std::abs(wrap_angle(heading_of(step) - heading));
    heading = heading_of(step);
    duration += step.norm() / route.speed;
    if (turn > route.turn_in_place_angle) duration += turn / route.turn_rate + 1.0;
    const bool last = i + 1 == route.points.size();
    if (!route.points[i].name.empty() && !last) duration += route.stand_at_points + 2.0;
  }
  return duration;
}

RouteFollower::RouteFollower(RouteConfig route) : route_(std::move(route)) {}

void RouteFollower::pause(Time now, double seconds) {
  stage_ = Stage::kPausing;
  pause_end_ = now + from_seconds(seconds);
}

void RouteFollower::pass(Time now, std::size_t index) {
  const std::string& name = route_.points[index].name;
  if (!name.empty()) waypoint_times_.push_back({name, now});
}

/// Ends a pause: the robot walks on, or the route is done.
void RouteFollower::set_off() {
  if (at_last()) {
    stage_ = Stage::kDone;
    return;
  }
  stage_ = Stage::kTurning;
  turns_left_ = next_ % 2 == 0;
}

/// The robot is at its next point: it stops there, or walks on at a point without a name.
void RouteFollower::reach_point() {
  const bool last = next_ + 1 == route_.points.size();
  if (last || !route_.points[next_].name.empty()) {
    stage_ = Stage::kStopping;
    resting_since_ = -1;
  } else {
    ++next_;
  }
}

/// Waits for the robot to rest; then the point is passed.
void RouteFollower::settle(Time now, bool resting) {
  if (!resting) resting_since_ = -1;
  if (resting && resting_since_ < 0) resting_since_ = now;
  if (resting_since_ < 0 || now - resting_since_ < kRestTime) return;
  pass(now, next_);
  ++next_;
  pause(now, at_last() ? route_.stand_after : route_.stand_at_points);
}

double RouteFollower::distance_left(const Pose& T_world_base) const {
  return at_last() ? 0.0 : (point(next_) - T_world_base.translation.head<2>()).norm();
}

RouteFollower::Pursuit RouteFollower::pursue(const Pose& T_world_base) const {
  const Eigen::Vector2d from = point(next_ - 1);
  const Eigen::Vector2d leg = point(next_) - from;
  const Eigen::Vector2d along = leg.normalized();
  const Eigen::Vector2d here = T_world_base.translation.head<2>();
  const double travelled = (here - from).dot(along);
  const Eigen::Vector2d goal = from + (travelled + route_.lookahead) * along;
  const double course = yaw_of(T_world_base.rotation) + route_.sideslip;
  return {.bearing = wrap_angle(heading_of(goal - here) - course),
          .distance = (goal - here).norm(),
          .left = leg.norm() - travelled};
}

VelocityCommand RouteFollower::turn(const Pose& T_world_base) {
  double error = pursue(T_world_base).bearing;
  if (std::abs(error) < kAligned) {
    stage_ = Stage::kWalking;
    return {};
  }
  if (std::abs(error) > kAmbiguousTurn && (error > 0.0) != turns_left_) {
    error += turns_left_ ? 2.0 * std::numbers::pi : -2.0 * std::numbers::pi;
  }
  const double rate = std::clamp(kTurnGain * std::abs(error), kSlowestTurn, route_.turn_rate);
  return {.yaw_rate = std::copysign(rate, error)};
}

VelocityCommand RouteFollower::walk(const Pose& T_world_base) {
  const Pursuit pursuit = pursue(T_world_base);
  const bool via = next_ + 1 < route_.points.size() && route_.points[next_].name.empty();
  if (pursuit.left < (via ? 0.5 * route_.lookahead : kStopDistance)) {
    reach_point();
    return {};
  }
  if (std::abs(pursuit.bearing) > route_.turn_in_place_angle) {
    stage_ = Stage::kTurning;
    turns_left_ = pursuit.bearing > 0.0;
    return {};
  }
  const double braking = std::max(kCreep, std::sqrt(2.0 * kDeceleration * pursuit.left));
  const double speed = via ? route_.speed : std::min(route_.speed, braking);
  VelocityCommand command;
  command.velocity = speed * Eigen::Vector2d(std::cos(route_.sideslip), std::sin(route_.sideslip));
  command.yaw_rate = 2.0 * speed * std::sin(pursuit.bearing) / pursuit.distance;
  return command;
}

VelocityCommand RouteFollower::command(Time now, const Pose& T_world_base, bool standing,
                                       double speed) {
  if (!started_) {
    pause(now, route_.stand_before);
    started_ = true;
  }
  switch (stage_) {
    case Stage::kPausing:
      if (now >= pause_end_) {
        if (next_ == 1) pass(now, 0);
        set_off();
      }
      return {};
    case Stage::kTurning:
      return turn(T_world_base);
    case Stage::kWalking:
      return walk(T_world_base);
    case Stage::kStopping:
      settle(now, standing && speed < kRestSpeed);
      return {};
    case Stage::kDone:
      return {};
  }
  return {};
}

void describe(Fields& f, RoutePoint& c) {
  f.text("name", c.name,
         {.meaning = "Name of the waypoint, at which the robot stops; empty: it does not stop."});
  f.number("x", c.x,
           {.unit = "m", .range = within(1e4), .meaning = "Position in the world frame."});
  f.number("y", c.y,
           {.unit = "m", .range = within(1e4), .meaning = "Position in the world frame."});
}

void describe(Fields& f, RouteConfig& c) {
  f.flag(
      "follow_scene", c.follow_scene,
      {.meaning = "Walk the centre line of the scene to its far end and back; replaces points."});
  f.list("points", c.points, "Points of the route in order; the robot starts at the first.");
  f.number("speed", c.speed,
           {.unit = "m/s", .range = in_range(0.1, 1.0), .meaning = "Walking speed."});
  f.number("turn_rate", c.turn_rate,
           {.unit = "rad/s",
            .range = in_range(0.3, 1.5),
            .meaning = "Largest yaw rate of a turn in place."});
  f.number("stand_before", c.stand_before,
           {.unit = "s", .range = up_to(1e6), .meaning = "Standing time before the first step."});
  f.number("stand_at_points", c.stand_at_points,
           {.unit = "s", .range = up_to(1e6), .meaning = "Standing time at each named point."});
  f.number("stand_after", c.stand_after,
           {.unit = "s", .range = up_to(1e6), .meaning = "Standing time after the last step."});
  f.number("lookahead", c.lookahead,
           {.unit = "m",
            .range = in_range(0.2, 3.0),
            .meaning = "Lookahead distance of the pure pursuit controller."});
  f.number("turn_in_place_angle", c.turn_in_place_angle,
           {.unit = "rad",
            .range = in_range(0.2, 1.5),
            .meaning = "Heading error beyond which the robot turns in place."});
  f.number("sideslip", c.sideslip,
           {.unit = "rad",
            .range = within(std::numbers::pi),
            .meaning = "Angle from the robot's heading to its velocity; 0: forward, pi/2: to its "
                       "left, pi: backward."});
}

}  // namespace aims
