// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/trajectory.hpp"
#include "sim/robot/gait.hpp"

namespace aims {

/// A point of the route; the robot does not stop at a point without a name.
struct RoutePoint {
  std::string name;
  double x = 0.0;  ///< [m]
  double y = 0.0;  ///< [m]
};
void describe(Fields& f, RoutePoint& c);

/// A route from point to point with a stop at each named one.
struct RouteConfig {
  std::vector<RoutePoint> points = {{"a", 0.0, 0.0}, {"b", 78.6, 0.0}, {"a", 0.0, 0.0}};
  double speed = 0.7;                ///< [m/s]
  double turn_rate = 0.9;            ///< in place [rad/s]
  double stand_before = 5.0;         ///< at the start [s]
  double stand_at_points = 1.0;      ///< at named points [s]
  double stand_after = 2.0;          ///< at the end [s]
  double lookahead = 0.6;            ///< of the pure pursuit [m]
  double turn_in_place_angle = 0.7;  ///< heading error beyond which the robot turns in place [rad]
  double sideslip = 0.0;             ///< angle from the robot's heading to its velocity [rad]
  bool follow_scene = false;         ///< the points are those of `points_along` (scene_route.hpp)
};
void describe(Fields& f, RouteConfig& c);

/// Error for fewer than two points or no length between neighbours.
Result<void> validate(const RouteConfig& route);

/// Length of the route over its speed, plus turns and pauses [s].
double nominal_duration(const RouteConfig& route);

/// Heading of a robot that walks from the first point to the second [rad].
double start_heading(const RouteConfig& route);

/// Steers the robot's base along a valid route.
class RouteFollower {
 public:
  explicit RouteFollower(RouteConfig route);

  /// Velocity command; `standing` and `speed` [m/s] are the present state of the robot.
  VelocityCommand command(Time now, const Pose& T_world_base, bool standing, double speed);

  /// Times at which the robot stood at named points so far; at the first point: when it sets off.
  const std::vector<WaypointTime>& waypoint_times() const { return waypoint_times_; }
  bool done() const { return stage_ == Stage::kDone; }

  /// The robot is on its way to a point: it turns, walks, or comes to rest there.
  bool under_way() const { return stage_ != Stage::kPausing && stage_ != Stage::kDone; }
  /// Index of the point it walks to next; the number of points after the last.
  std::size_t next_point() const { return next_; }
  /// Distance to that point [m]; zero after the last.
  double distance_left(const Pose& T_world_base) const;

 private:
  enum class Stage { kPausing, kTurning, kWalking, kStopping, kDone };

  /// Pure pursuit of the line through the last and the next point.
  struct Pursuit {
    double bearing;   ///< of the point to steer to, from the direction the robot walks in [rad]
    double distance;  ///< to that point [m]
    double left;      ///< along the line to the next point [m]
  };

  Eigen::Vector2d point(std::size_t i) const { return {route_.points[i].x, route_.points[i].y}; }
  bool at_last() const { return next_ >= route_.points.size(); }
  void pass(Time now, std::size_t index);
  void set_off();
  void pause(Time now, double seconds);
  void reach_point();
  void settle(Time now, bool resting);
  Pursuit pursue(const Pose& T_world_base) const;
  VelocityCommand turn(const Pose& T_world_base);
  VelocityCommand walk(const Pose& T_world_base);

  RouteConfig route_;
  Stage stage_ = Stage::kPausing;
  std::size_t next_ = 1;  ///< the point the robot walks to
  Time pause_end_ = 0;
  Time resting_since_ = -1;
  bool started_ = false;
  bool turns_left_ = false;  ///< direction of a turn of about 180 degrees
  std::vector<WaypointTime> waypoint_times_;
};

}  // namespace aims
