// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/config.hpp"
#include "sim/environment/wall.hpp"

namespace aims {

/// Panes of glass in a corridor's walls. A beam that meets one steeply is returned; any other
/// passes through, both ways, and meets what is behind.
struct GlassConfig {
  double share = 0.0;         ///< of the walls' length that is glass [-]; 0: none
  double pane = 2.0;          ///< length of a pane [m]
  double limit_deg = 10.0;    ///< largest angle of incidence that returns a beam [deg]
  double reflectivity = 0.5;  ///< within that angle, as of a diffuse surface [-]
  double behind = 1.0;        ///< from the walls' faces to the second walls behind them [m]
};

void describe(Fields& fields, GlassConfig& config);

/// The material of the panes.
Material glass_material(const GlassConfig& config);

/// The panes in a wall, in order: regularly spaced over `along`, cut off at the doors' frames.
std::vector<Span> glass_panes(const GlassConfig& config, const Span& along,
                              const std::vector<Span>& doors);

}  // namespace aims
