// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/garage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "sim/environment/wall.hpp"

namespace aims {
namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
constexpr double kGateWidth = 3.0;   ///< [m]
constexpr double kGateHeight = 2.4;  ///< [m]
constexpr double kGateDepth = 0.25;  ///< [m]
constexpr double kDoorWidth = 0.9;   ///< of the hall [m]
constexpr double kPillar = 0.5;      ///< width of a pillar [m]
constexpr double kBayWidth = 2.7;    ///< of a parking bay [m]
constexpr int kMaxCars = 5;          ///< each collides, which costs physics time

/// The hall's faces in the world [m].
struct Hall {
  double west, east, south, north, height;
};

Hall hall_of(const GarageConfig& c) {
  return {.west = c.approach - c.opening_distance,
          .east = c.approach + c.hall_extent,
          .south = -c.opening_distance,
          .north = c.hall_extent,
          .height = c.hall_height};
}

Material shaded(Material material, float shade) {
  material.color = (shade * material.color).cwiseMin(1.0F);
  return material;
}

/// A wall of the hall from one point of its own line to another; the hall is on the right.
void add_hall_wall(const Pose& T_world_line, const Span& outer, const Hall& hall,
                   const std::vector<Span>& doors, double door_depth, double door_height,
                   const Materials& materials, std::vector<Solid>& solids) {
  SideBuilder side(T_world_line, Side::kLeft, 0.0, solids);
  add_wall({outer, hall.height, openings_at(doors, door_height), door_depth, {}}, materials, side);
}

/// A wall with a corridor's opening at the origin of its line, and the lintel above it.
void add_wall_with_opening(const GarageConfig& c, const Pose& T_world_line, const Span& outer,
                           const Hall& hall, const Span& door, const Materials& materials,
                           std::vector<Solid>& solids) {
  const double opening = 0.5 * c.width + kOverlap;
  const DoorConfig& doors = c.doors;
  add_hall_wall(T_world_line, {outer.begin, -opening}, hall, {door}, doors.depth, doors.height,
                materials, solids);
  add_hall_wall(T_world_line, {opening, outer.end}, hall, {}, doors.depth, doors.height, materials,
                solids);
  SideBuilder side(T_world_line, Side::kLeft, 0.0, solids);
  side.box({-opening - kOverlap, opening + kOverlap}, 0.0, kWallThickness, c.height,
           hall.height + kOverlap, materials.wall);
}

void add_hall_walls(const GarageConfig& c, const Hall& hall, const Materials& materials,
                    std::vector<Solid>& solids) {
  const double t = kWallThickness;
  const double width = hall.east - hall.west;
  const double depth = hall.north - hall.south;
  const auto door = [](double centre) {
    return Span{centre - 0.5 * kDoorWidth, centre + 0.5 * kDoorWidth};
  };
  const auto gate = [](double centre) {
    return Span{centre - 0.5 * kGateWidth, centre + 0.5 * kGateWidth};
  };
  // West, going north, and south, going west: the corridors open through them.
  add_wall_with_opening(c, line_at(hall.west, 0.0, kQuarterTurn), {hall.south - t, hall.north + t},
                        hall, door(0.6 * hall.south), materials, solids);
  add_wall_with_opening(c, line_at(c.approach, hall.south, 2.0 * kQuarterTurn),
                        {c.approach - hall.east - t, c.approach - hall.west + t}, hall,
                        door(0.3 * (c.approach - hall.east)), materials, solids);
  add_hall_wall(line_at(hall.west, hall.north, 0.0), {-t, width + t}, hall,
                {door(0.15 * width), door(0.9 * width)}, c.doors.depth, c.doors.height, materials,
                solids);
  add_hall_wall(line_at(hall.east, hall.north, -kQuarterTurn), {-t, depth + t}, hall,
                {gate(0.25 * depth), gate(0.55 * depth)}, kGateDepth, kGateHeight, materials,
                solids);
  Solid ceiling =
      cross_box(line_at(hall.west, 0.5 * (hall.north + hall.south), 0.0), {-t, width + t},
                0.5 * depth + t, hall.height, hall.height + t, materials.ceiling);
  ceiling.collides = false;
  ceiling.roof = true;
  solids.push_back(ceiling);
}

void add_pillars(const GarageConfig& c, const Hall& hall, const Materials& materials,
                 std::vector<Solid>& solids) {
  const double off_axis = 0.4 * c.opening_distance;
  for (const double x : {c.approach - off_axis, c.approach + 0.5 * c.hall_extent}) {
    for (const double y : {-off_axis - 0.5 * kPillar, 0.4 * c.hall_extent}) {
      solids.push_back(cross_box(line_at(x, y, 0.0), {-0.5 * kPillar, 0.5 * kPillar}, 0.5 * kPillar,
                                 -kOverlap, hall.height + kOverlap, materials.pillar));
    }
  }
}

/// A car at the origin of `T_world_car`, its nose along x: body, cabin and four wheels.
void add_car(const Pose& T_world_car, const Material& paint, const Material& tyre,
             std::vector<Solid>& solids) {
  solids.push_back(cross_box(T_world_car, {-2.1, 2.1}, 0.87, 0.22, 0.85, paint));
  Solid cabin = cross_box(T_world_car, {-1.5, 0.75}, 0.76, 0.85, 1.45, shaded(paint, 0.6F));
  cabin.collides = false;
  solids.push_back(cabin);
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(kQuarterTurn, Eigen::Vector3d::UnitX()));
  for (const double x : {-1.3, 1.3}) {
    for (const double y : {-0.78, 0.78}) {
      Solid wheel;
      wheel.shape = Shape::kCylinder;
      wheel.T_world_solid = T_world_car * Pose{lying, Eigen::Vector3d(x, y, 0.31)};
      wheel.half_extents = {0.31, 0.31, 0.1};
      wheel.material = tyre;
      wheel.collides = false;
      solids.push_back(wheel);
    }
  }
}

/// Cars in bays along the north wall, each parked a little differently.
void add_cars(const GarageConfig& c, const Hall& hall, const Materials& materials,
              std::uint64_t seed, std::vector<Solid>& solids) {
  const std::array<Eigen::Vector3f, kMaxCars> paints = {
      Eigen::Vector3f(0.62F, 0.15F, 0.14F), Eigen::Vector3f(0.18F, 0.30F, 0.52F),
      Eigen::Vector3f(0.80F, 0.80F, 0.82F), Eigen::Vector3f(0.20F, 0.36F, 0.26F),
      Eigen::Vector3f(0.35F, 0.35F, 0.38F)};
  const Material tyre = {materials.clutter.reflectivity, {0.08F, 0.08F, 0.09F}};
  RandomStream random = rng(seed, "scene.garage.cars");
  for (int i = 0; i < c.cars; ++i) {
    const double x = hall.west + 3.2 + kBayWidth * i + random.uniform(-0.2, 0.2);
    const double y = hall.north - 2.9 + random.uniform(-0.3, 0.3);
    const double nose = random.chance(0.5) ? kQuarterTurn : -kQuarterTurn;
    const double heading = nose + random.uniform(-0.04, 0.04);
    add_car(line_at(x, y, heading), {materials.clutter.reflectivity, paints[i]}, tyre, solids);
  }
}

/// A ramp to an upper floor that ends at the east wall: a box half sunk into the floor.
void add_upward_ramp(const Hall& hall, const Materials& materials, std::vector<Solid>& solids) {
  constexpr double kLength = 6.0;
  constexpr double kRise = 1.2;
  constexpr double kHalfThickness = 0.65;
  const double slope = std::atan2(kRise, kLength);
  const Eigen::Vector3d normal(-std::sin(slope), 0.0, std::cos(slope));
  const Eigen::Vector3d middle(hall.east - 0.4 - 0.5 * kLength, hall.south + 2.2, 0.5 * kRise);
  Solid wedge;
  wedge.T_world_solid = {Eigen::Quaterniond(Eigen::AngleAxisd(-slope, Eigen::Vector3d::UnitY())),
                         middle - kHalfThickness * normal};
  wedge.half_extents = {0.5 * std::hypot(kLength, kRise), 1.5, kHalfThickness};
  wedge.material = shaded(materials.pillar, 0.75F);
  solids.push_back(wedge);
}

CorridorArm arm_of(const GarageConfig& c, double length, std::uint64_t seed,
                   const std::string& stream) {
  CorridorArm arm;
  arm.along = {-c.margin, length - c.opening_distance};
  arm.width = c.width;
  arm.height = c.height;
  arm.begin_closed = true;
  arm.door_depth = c.doors.depth;
  arm.left = openings_at(door_openings(c.doors, arm.along, Side::kLeft, seed, stream + ".left"),
                         c.doors.height);
  arm.right = openings_at(door_openings(c.doors, arm.along, Side::kRight, seed, stream + ".right"),
                          c.doors.height);
  return arm;
}

}  // namespace

void describe(Fields& f, GarageConfig& c) {
  f.number(
      "approach", c.approach,
      {.unit = "m", .range = in_range(10.0, 500.0), .meaning = "Distance from a to d, along +x."});
  f.number(
      "exit", c.exit,
      {.unit = "m", .range = in_range(10.0, 500.0), .meaning = "Distance from d to h, along -y."});
  f.number("margin", c.margin,
           {.unit = "m",
            .range = in_range(1.0, 500.0),
            .meaning = "Length of corridor behind a and behind h, up to the end walls."});
  f.number("width", c.width,
           {.unit = "m", .range = in_range(1.0, 4.0), .meaning = "Width of both corridors."});
  f.number("height", c.height,
           {.unit = "m", .range = in_range(1.0, 10.0), .meaning = "Height of both corridors."});
  f.number("opening_distance", c.opening_distance,
           {.unit = "m",
            .range = in_range(7.0, 50.0),
            .meaning = "Distance from d to the opening of either corridor into the hall."});
  f.number("hall_extent", c.hall_extent,
           {.unit = "m",
            .range = in_range(11.0, 100.0),
            .meaning = "Extent of the hall beyond d, along +x and along +y."});
  f.number("hall_height", c.hall_height,
           {.unit = "m",
            .range = in_range(2.5, 20.0),
            .meaning = "Height of the hall from floor to ceiling."});
  f.integer("cars", c.cars,
            {.unit = "-",
             .range = in_range(0, kMaxCars),
             .meaning = "Number of cars parked in the hall."});
  f.group("doors", c.doors);
}

Result<void> validate(const GarageConfig& config) {
  const double min_height = std::max(config.height, kGateHeight) + 0.1;
  if (config.hall_height < min_height) {
    return failure(fmt::format(
        "scene.garage.hall_height: expected at least {} m (above corridors and gates), got {}",
        min_height, config.hall_height));
  }
  const double min_length = config.opening_distance + 1.0;
  if (std::min(config.approach, config.exit) < min_length) {
    return failure(fmt::format(
        "scene.garage.{}: expected at least {} m (1 m of corridor before the hall), got {}",
        config.approach < min_length ? "approach" : "exit", min_length,
        std::min(config.approach, config.exit)));
  }
  return validate_doors(config.doors, config.height, "scene.garage.doors");
}

std::vector<Solid> garage_solids(const GarageConfig& config, const ReflectivityConfig& reflectivity,
                                 std::uint64_t seed) {
  const Materials materials = building_materials(reflectivity);
  const Hall hall = hall_of(config);
  std::vector<Solid> solids;
  add_arm(arm_of(config, config.approach, seed, "scene.garage.doors.first"), materials, solids);
  // The second arm's own x axis runs from h towards the hall.
  CorridorArm second = arm_of(config, config.exit, seed, "scene.garage.doors.second");
  second.T_world_arm = line_at(config.approach, -config.exit, kQuarterTurn);
  add_arm(second, materials, solids);
  add_hall_walls(config, hall, materials, solids);
  add_pillars(config, hall, materials, solids);
  add_cars(config, hall, materials, seed, solids);
  add_upward_ramp(hall, materials, solids);
  return solids;
}

Floor garage_floor(const GarageConfig& config) {
  constexpr double kBeyond = 1.0;  ///< outside of every wall [m]
  const Hall hall = hall_of(config);
  Floor floor;
  floor.min_corner = {-config.margin - kBeyond, -config.exit - config.margin - kBeyond};
  floor.max_corner = {hall.east + kBeyond, hall.north + kBeyond};
  return floor;
}

}  // namespace aims
