// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/glass.hpp"

#include <cmath>

#include "core/angle.hpp"

namespace aims {
namespace {

constexpr double kFrame = 0.1;          ///< of wall beside a door [m]
constexpr double kNarrowestPane = 0.1;  ///< [m]

/// Adds the part of a pane that remains beside a door, unless it is too narrow.
void add_rest(const Span& pane, std::vector<Span>& panes) {
  if (pane.length() >= kNarrowestPane) panes.push_back(pane);
}

}  // namespace

void describe(Fields& f, GlassConfig& c) {
  f.number("fraction", c.fraction,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning =
                "Fraction of the length of the walls that is glass, doors excluded; 0 for none."});
  f.number("pane_length", c.pane_length,
           {.unit = "m", .range = in_range(0.2, 50.0), .meaning = "Length of one pane."});
  f.number("max_incidence_deg", c.max_incidence_deg,
           {.unit = "deg",
            .range = in_range(0.0, 90.0),
            .meaning = "Largest angle of incidence at which a pane returns a beam; beams at larger "
                       "angles pass through."});
  f.number("reflectivity", c.reflectivity,
           {.unit = "-",
            .range = {.min = 0.0, .max = 1.0, .min_included = false},
            .meaning = "Diffuse reflectivity of a pane within that angle of incidence."});
  f.number(
      "backing_distance", c.backing_distance,
      {.unit = "m",
       .range = in_range(0.5, 20.0),
       .meaning = "Distance from the faces of the walls to the second walls behind the glass."});
}

Material glass_material(const GlassConfig& config) {
  // Never opaque: at 90 degrees the limit still is a positive cosine.
  const double cosine = std::max(std::cos(config.max_incidence_deg * kRadiansPerDegree), 1e-9);
  return {config.reflectivity, {0.62F, 0.80F, 0.84F}, cosine};
}

std::vector<Span> glass_panes(const GlassConfig& config, const Span& along,
                              const std::vector<Span>& doors) {
  std::vector<Span> panes;
  if (config.fraction <= 0.0) return panes;
  // Whole periods of pane and wall, so that the fraction holds for the whole wall.
  const double count =
      std::max(1.0, std::round(along.length() * config.fraction / config.pane_length));
  const double period = along.length() / count;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const double centre = along.begin + (i + 0.5) * period;
    Span rest{centre - 0.5 * config.fraction * period, centre + 0.5 * config.fraction * period};
    for (const Span& door : doors) {
      if (door.end + kFrame <= rest.begin || door.begin - kFrame >= rest.end) continue;
      add_rest({rest.begin, door.begin - kFrame}, panes);
      rest.begin = door.end + kFrame;
    }
    add_rest(rest, panes);
  }
  return panes;
}

}  // namespace aims
