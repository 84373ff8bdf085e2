// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/ramp.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kLargestCell = 0.25;  ///< of the floor's grid [m]

}  // namespace

void describe(Fields& f, RampConfig& c) {
  f.number("start", c.start,
           {.unit = "m",
            .range = up_to(2000.0),
            .meaning = "Position along x at which the floor begins to rise."});
  f.number("length", c.length,
           {.unit = "m", .range = in_range(0.5, 200.0), .meaning = "Length of the slope along x."});
  f.number("grade", c.grade,
           {.unit = "-",
            .range = in_range(0.0, 0.25),
            .meaning = "Rise of the slope over its length; 0 for a level floor."});
}

double ramp_height(const RampConfig& ramp, double x) {
  return ramp.grade * std::clamp(x - ramp.start, 0.0, ramp.length);
}

double ramp_rise(const RampConfig& ramp) { return ramp.grade * ramp.length; }

void add_ramp(const RampConfig& ramp, Floor& floor) {
  if (ramp.grade <= 0.0) return;
  const double cell = ramp.length / std::ceil(ramp.length / kLargestCell);
  const double before = std::ceil((ramp.start - floor.min_corner.x()) / cell);
  const double behind = std::ceil((floor.max_corner.x() - ramp.start) / cell);
  const double rows = std::ceil((floor.max_corner.y() - floor.min_corner.y()) / cell);
  floor.min_corner.x() = ramp.start - before * cell;
  floor.max_corner.x() = ramp.start + behind * cell;
  floor.columns = static_cast<int>(before + behind) + 1;
  floor.rows = static_cast<int>(rows) + 1;
  floor.heights.clear();
  for (int row = 0; row < floor.rows; ++row) {
    for (int column = 0; column < floor.columns; ++column) {
      const double x = ramp.start + (column - before) * cell;
      floor.heights.push_back(static_cast<float>(ramp_height(ramp, x)));
    }
  }
}

}  // namespace aims
