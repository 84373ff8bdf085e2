// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/building_config.hpp"

#include <fmt/format.h>

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

void describe(Fields& f, PanelConfig& c) {
  f.number("spacing", c.spacing,
           {.unit = "m",
            .range = up_to(100.0),
            .meaning = "Distance between joints of boards on walls; 0 for none.",
            .source = "boards are 1.2 or 1.25 m wide"});
  f.number("crown", c.crown,
           {.unit = "m",
            .range = in_range(0.0, 0.01),
            .meaning = "Height of the filler over a joint above the boards.",
            .source = "assumption; BS 8212 permits 3 mm under 0.45 m"});
  f.number("width", c.width,
           {.unit = "m",
            .range = in_range(0.05, 2.0),
            .meaning = "Width of the filler over a joint.",
            .source = "finish coat: 0.25 m, at butt joints 0.45 m"});
}

void describe(Fields& f, SurfaceConfig& c) {
  f.number("relief", c.relief,
           {.unit = "m",
            .range = in_range(0.0, 0.02),
            .meaning = "Standard deviation of the heights of walls, ceiling and floor as the LiDAR "
                       "sees them; 0 for planes.",
            .source = "DIN 18202, finished walls: 5 mm under 1 m, 10 mm under 4 m"});
  f.number("texture", c.texture,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning = "Standard deviation of the logarithm of the reflectivity on one surface."});
  f.number("shortest", c.shortest,
           {.unit = "m",
            .range = in_range(0.15, 5.0),
            .meaning = "Shortest wavelength of relief and texture."});
  f.number("longest", c.longest,
           {.unit = "m",
            .range = in_range(0.15, 5.0),
            .meaning = "Longest wavelength of relief and texture."});
  f.group("panels", c.panels);
}

Result<void> validate(const SurfaceConfig& config) {
  const PanelConfig& panels = config.panels;
  if (panels.spacing > 0.0 && panels.width > panels.spacing) {
    return failure(
        fmt::format("scene.surface.panels.width: expected at most "
                    "scene.surface.panels.spacing ({} m), got {} m",
                    panels.spacing, panels.width));
  }
  if (config.shortest <= config.longest) return {};
  return failure(
      fmt::format("scene.surface.shortest: expected at most scene.surface.longest "
                  "({} m), got {} m",
                  config.longest, config.shortest));
}

}  // namespace aims
