// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aims::independent {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kTouch = 1e-9;  ///< how near to a wall an opening must lie [m]

/// Distances at which a ray enters and leaves a box; it misses the box when enter > leave.
struct Crossing {
  double enter = -kFar;
  double leave = kFar;
};

Crossing crossing(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& inverse) {
  Crossing crossing;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.min()[axis] - origin[axis]) * inverse[axis];
    const double b = (box.max()[axis] - origin[axis]) * inverse[axis];
    crossing.enter = std::max(crossing.enter, std::min(a, b));
    crossing.leave = std::min(crossing.leave, std::max(a, b));
  }
  return crossing;
}

/// Inverse of a direction, finite also for a component of zero.
Eigen::Vector3d inverse_of(const Eigen::Vector3d& direction) {
  return direction.unaryExpr(
      [](double each) { return std::abs(each) > 1e-300 ? 1.0 / each : 1e300; });
}

/// The recess with the air before it where the wall stands out by up to `bound`.
Box opened(Box recess, const Box& room, double bound) {
  const bool left = recess.min().y() > room.center().y();
  (left ? recess.min() : recess.max()).y() += left ? -bound : bound;
  return recess;
}

/// Whether the point is in the box's opening, seen along y.
bool opens_at(const Box& recess, const Eigen::Vector3d& point) {
  return point.x() > recess.min().x() && point.x() < recess.max().x() &&
         point.z() > recess.min().z() && point.z() < recess.max().z() &&
         point.y() > recess.min().y() - kTouch && point.y() < recess.max().y() + kTouch;
}

/// Distance to a vertical cylinder from outside; infinite without a hit.
double distance_to(const Pillar& pillar, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction) {
  const double dx = origin.x() - pillar.x;
  const double dy = origin.y() - pillar.y;
  const double a = direction.x() * direction.x() + direction.y() * direction.y();
  const double b = dx * direction.x() + dy * direction.y();
  const double c = dx * dx + dy * dy - pillar.radius * pillar.radius;
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0.0) || b >= 0.0) return kFar;
  return (-b - std::sqrt(discriminant)) / a;
}

}  // namespace

double World::distance(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d inverse = inverse_of(direction);
  double nearest =
      relief ? relief->distance(origin, direction, reach) : crossing(room, origin, inverse).leave;
  const Eigen::Vector3d end = origin + nearest * direction;
  for (const Box& each : recesses) {
    const Box recess = relief ? opened(each, room, relief->bound()) : each;
    if (!opens_at(recess, end)) continue;
    nearest = crossing(recess, origin, inverse).leave;
    break;
  }
  for (const Box& box : boxes) {
    const Crossing hit = crossing(box, origin, inverse);
    if (hit.enter <= hit.leave && hit.enter > 0.0) nearest = std::min(nearest, hit.enter);
  }
  for (const Pillar& pillar : pillars) {
    nearest = std::min(nearest, distance_to(pillar, origin, direction));
  }
  return nearest;
}

World World::within(const Eigen::Vector3d& origin, double range) const {
  World near{room, {}, {}, {}, relief, range};
  const auto reaches = [&](const Box& box) { return box.exteriorDistance(origin) < range; };
  std::ranges::copy_if(recesses, std::back_inserter(near.recesses), reaches);
  std::ranges::copy_if(boxes, std::back_inserter(near.boxes), reaches);
  std::ranges::copy_if(pillars, std::back_inserter(near.pillars), [&](const Pillar& pillar) {
    return std::hypot(pillar.x - origin.x(), pillar.y - origin.y()) - pillar.radius < range;
  });
  return near;
}

}  // namespace aims::independent
