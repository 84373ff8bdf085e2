// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/building_config.hpp"

namespace aims {

std::vector<std::pair<std::string, WallSides>> side_options() {
  return {{"none", WallSides::kNone},
          {"left", WallSides::kLeft},
          {"right", WallSides::kRight},
          {"both", WallSides::kBoth},
          {"alternate", WallSides::kAlternate}};
}

void describe(Fields& f, DoorConfig& c) {
  f.choice("sides", c.sides, side_options(), {.meaning = "Walls with doors, looking along +x."});
  f.number("spacing", c.spacing,
           {.unit = "m",
            .range = in_range(0.5, 1000.0),
            .meaning = "Distance between the centres of two doors in one wall."});
  f.number("jitter", c.jitter,
           {.unit = "m",
            .range = up_to(100.0),
            .meaning = "Largest random shift of a door along its wall."});
  f.number("depth", c.depth,
           {.unit = "m",
            .range = in_range(0.001, 1.0),
            .meaning = "Distance of a door's face behind the face of the wall."});
  f.number("width", c.width,
           {.unit = "m", .range = in_range(0.1, 10.0), .meaning = "Width of a door opening."});
  f.number("height", c.height,
           {.unit = "m", .range = in_range(0.5, 10.0), .meaning = "Height of a door opening."});
}

void describe(Fields& f, ReflectivityConfig& c) {
  const Range range = {.min = 0.0, .max = 1.0, .min_included = false};
  f.number("wall", c.wall,
           {.unit = "-", .range = range, .meaning = "Diffuse reflectivity of walls and pillars."});
  f.number("floor", c.floor,
           {.unit = "-", .range = range, .meaning = "Diffuse reflectivity of the floor."});
  f.number("ceiling", c.ceiling,
           {.unit = "-", .range = range, .meaning = "Diffuse reflectivity of the ceiling."});
  f.number("door", c.door,
           {.unit = "-", .range = range, .meaning = "Diffuse reflectivity of the doors."});
  f.number(
      "clutter", c.clutter,
      {.unit = "-", .range = range, .meaning = "Diffuse reflectivity of clutter and parked cars."});
}

}  // namespace aims
