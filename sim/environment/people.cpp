// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/people.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kRobotHalfWidth = 0.4;  ///< with its sway about the centre line [m]

/// Where a ray enters a standing cylinder.
struct Entry {
  double distance;  ///< [m]
  Eigen::Vector3d normal;
};

std::optional<Entry> enter_cylinder(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                    const Person& person, const Eigen::Vector2d& axis) {
  const double radius = person.radius;
  const Eigen::Vector2d to_axis = axis - origin.head<2>();
  const double a = direction.head<2>().squaredNorm();
  const double b = to_axis.dot(direction.head<2>());
  const double c = to_axis.squaredNorm() - radius * radius;
  const double discriminant = b * b - a * c;
  if (c <= 0.0 || b <= 0.0 || discriminant <= 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  const double side = (b - root) / a;
  const double bottom = person.ground;
  const double height = bottom + person.height;
  const double z = origin.z() + side * direction.z();
  if (z >= bottom && z <= height) {
    const Eigen::Vector2d outwards = (side * direction.head<2>() - to_axis) / radius;
    return Entry{side, {outwards.x(), outwards.y(), 0.0}};
  }
  // From above, a ray may come down on the cylinder's top before it leaves its side.
  if (z <= height) return std::nullopt;
  const double top = (height - origin.z()) / direction.z();
  if (top < side || top > (b + root) / a) return std::nullopt;
  return Entry{top, Eigen::Vector3d::UnitZ()};
}

/// The point `y` [m] to the left of the centre line at `x` along it.
Eigen::Vector2d place_on(const Stretch& stretch, double x, double y) {
  Eigen::Vector3d place(x, y, 0.0);
  if (stretch.turn != 0.0) {
    const double radius = stretch.along.length() / stretch.turn;
    const double turned = x / radius;
    place = {(radius - y) * std::sin(turned), radius - (radius - y) * std::cos(turned), 0.0};
  }
  return (stretch.T_world_stretch * place).head<2>();
}

/// False when every ray of the packet passes beside the person.
bool may_intersect(const Person& person, const RayPacket& rays,
                   const std::array<Time, kRayPacketSize>& stamps) {
  const Eigen::Vector2d axis = person.position(stamps.front());
  const double walked = person.speed * to_seconds(stamps.back() - stamps.front());
  const double clear = person.radius + std::abs(walked) + 0.01;
  bool near = false;
  for (int lane = 0; lane < kRayPacketSize; ++lane) {
    const double x = axis.x() - rays.origin_x[lane];
    const double y = axis.y() - rays.origin_y[lane];
    const double across = rays.direction_x[lane] * y - rays.direction_y[lane] * x;
    const double flat = rays.direction_x[lane] * rays.direction_x[lane] +
                        rays.direction_y[lane] * rays.direction_y[lane];
    near |= across * across <= clear * clear * flat;
  }
  return near;
}

}  // namespace

void describe(Fields& f, PeopleConfig& c) {
  f.integer("count", c.count,
            {.unit = "-",
             .range = in_range(0, 100),
             .meaning = "Number of people who walk up and down the corridor."});
  f.number("speed", c.speed,
           {.unit = "m/s", .range = in_range(0.0, 3.0), .meaning = "Walking speed of a person."});
  f.number("radius", c.radius,
           {.unit = "m",
            .range = in_range(0.05, 0.5),
            .meaning = "Radius of the upright cylinder that models a person."});
  f.number("height", c.height,
           {.unit = "m",
            .range = in_range(0.5, 2.5),
            .meaning = "Height of the upright cylinder that models a person."});
  f.number("lane_offset", c.lane_offset,
           {.unit = "m",
            .range = up_to(100.0),
            .meaning = "Distance of a person's path from the centre line of the corridor."});
  f.number("reflectivity", c.reflectivity,
           {.unit = "-",
            .range = {.min = 0.0, .max = 1.0, .min_included = false},
            .meaning = "Diffuse reflectivity of clothes."});
}

Result<void> validate(const PeopleConfig& config, double corridor_width) {
  if (config.count == 0) return {};
  const double min_offset = kRobotHalfWidth + config.radius;
  const double max_offset = 0.5 * corridor_width - config.radius;
  if (config.lane_offset < min_offset || config.lane_offset > max_offset) {
    return failure(fmt::format(
        "scene.people.lane_offset: expected {:.2f} to {:.2f} m (beside the robot, clear of "
        "the walls), got {}",
        min_offset, max_offset, config.lane_offset));
  }
  return {};
}

std::vector<Person> people_on(std::span<const Stretch> stretches, const PeopleConfig& config,
                              std::uint64_t seed) {
  RandomStream random = rng(seed, "scene.people");
  std::vector<Person> people;
  for (int i = 0; i < config.count; ++i) {
    const Stretch& stretch = stretches[static_cast<std::size_t>(i) % stretches.size()];
    Person& person = people.emplace_back();
    const double y = random.chance(0.5) ? config.lane_offset : -config.lane_offset;
    person.from = place_on(stretch, stretch.along.begin, y);
    person.to = place_on(stretch, stretch.along.end, y);
    person.turn = stretch.turn;
    person.ground = stretch.ground;
    person.speed = config.speed;
    person.start = random.uniform(0.0, 2.0 * person.distance());
    person.radius = config.radius;
    person.height = config.height;
    person.material = {config.reflectivity, {0.22F, 0.32F, 0.50F}};
  }
  return people;
}

void intersect_people(const std::vector<Person>& people, const RayPacket& rays,
                      const std::array<Time, kRayPacketSize>& stamps, int first_surface,
                      float max_distance, HitPacket& hits) {
  for (std::size_t i = 0; i < people.size(); ++i) {
    const Person& person = people[i];
    if (!may_intersect(person, rays, stamps)) continue;
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      const Eigen::Vector3d origin(rays.origin_x[lane], rays.origin_y[lane], rays.origin_z[lane]);
      const Eigen::Vector3d direction(rays.direction_x[lane], rays.direction_y[lane],
                                      rays.direction_z[lane]);
      const auto entry = enter_cylinder(origin, direction, person, person.position(stamps[lane]));
      if (!entry || entry->distance >= hits.distance[lane] || entry->distance > max_distance) {
        continue;
      }
      hits.distance[lane] = static_cast<float>(entry->distance);
      hits.normal_x[lane] = static_cast<float>(entry->normal.x());
      hits.normal_y[lane] = static_cast<float>(entry->normal.y());
      hits.normal_z[lane] = static_cast<float>(entry->normal.z());
      hits.surface[lane] = first_surface + static_cast<int>(i);
    }
  }
}

}  // namespace aims
