// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/config.hpp"
#include "sim/environment/wall.hpp"

namespace aims {

/// Panes of glass in a corridor's walls. A pane returns beams near normal incidence; all others
/// pass through, both ways, and hit the wall behind it.
struct GlassConfig {
  double fraction = 0.0;            ///< of the length of the walls that is glass [-]; 0: none
  double pane_length = 2.0;         ///< [m]
  double max_incidence_deg = 10.0;  ///< largest angle of incidence that returns a beam [deg]
  double reflectivity = 0.5;        ///< diffuse, within that angle [-]
  double backing_distance = 1.0;    ///< from the walls to the second walls behind them [m]
};

void describe(Fields& fields, GlassConfig& config);

/// The material of the panes.
Material glass_material(const GlassConfig& config);

/// The panes in a wall, in order: regularly spaced over `along`, cut off at the doors' frames.
std::vector<Span> glass_panes(const GlassConfig& config, const Span& along,
                              const std::vector<Span>& doors);

}  // namespace aims
