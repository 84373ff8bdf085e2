// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"

namespace aims {

/// A side of a corridor, looking along it: left is +y of its own axes.
enum class Side { kLeft, kRight };

/// Walls of a corridor that have a feature, looking along it.
enum class WallSides { kNone, kLeft, kRight, kBoth, kAlternate };

/// Doors set back into the walls.
struct DoorConfig {
  WallSides sides = WallSides::kRight;
  double spacing = 8.0;  ///< between the centres of two doors in one wall [m]
  double jitter = 0.5;   ///< largest random shift of a door along its wall [m]
  double depth = 0.15;   ///< of the door's face behind the wall's face [m]
  double width = 0.9;    ///< of the opening [m]
  double height = 2.05;  ///< of the opening [m]
};

/// Diffuse reflectivities at the LiDAR's wavelength [-].
struct ReflectivityConfig {
  double wall = 0.5;
  double floor = 0.25;
  double ceiling = 0.6;
  double door = 0.35;
  double clutter = 0.4;
};

/// Joints of boards on upright surfaces, all the same: a crown of filler over each.
struct PanelConfig {
  double spacing = 0.0;  ///< between joints [m]; 0: none
  double crown = 0.001;  ///< height of the filler over the boards [m]
  double width = 0.3;    ///< of the filler [m]
};

/// Walls, ceiling and floor as they are built: not quite flat, and not of one reflectivity. Both are
/// Gaussian random fields, a sum of waves with lengths from `shortest` to `longest`. The variance per
/// octave grows with the wavelength, as the tolerances of DIN 18202 do: for finished walls 3 mm
/// under a straight edge of 0.1 m, 5 mm of 1 m, 10 mm of 4 m.
struct SurfaceConfig {
  double relief = 0.0;    ///< standard deviation of the heights [m]; 0: planes
  double texture = 0.0;   ///< standard deviation of the logarithm of the reflectivity [-]
  double shortest = 0.3;  ///< wavelength [m]
  double longest = 3.0;   ///< wavelength [m]
  PanelConfig panels;

  bool is_plain() const { return relief == 0.0 && texture == 0.0 && panels.spacing == 0.0; }
};

void describe(Fields& fields, DoorConfig& config);
void describe(Fields& fields, ReflectivityConfig& config);
void describe(Fields& fields, PanelConfig& config);
void describe(Fields& fields, SurfaceConfig& config);

/// Error when the shortest wave is longer than the longest, or joints are wider than their spacing.
Result<void> validate(const SurfaceConfig& config);

/// Names of `WallSides` in a configuration.
std::vector<std::pair<std::string, WallSides>> side_options();

}  // namespace aims
