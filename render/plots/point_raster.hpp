// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/plots/image.hpp"

namespace aims {

/// A rectangle of a plane seen at right angles: u to the right, v upwards [m].
struct RasterWindow {
  double u_min = 0.0;
  double u_max = 1.0;
  double v_min = 0.0;
  double v_max = 1.0;
};

/// One point to draw.
struct RasterPoint {
  float u = 0.0F;         ///< [m]
  float v = 0.0F;         ///< [m]
  float nearness = 0.0F;  ///< the larger hides the smaller [m]
  float height = 0.0F;    ///< in [0, 1], of `height_color`
};

/// Draws the points as squares of `size` pixels over `background`, each pixel by the nearest of
/// its points. Creases are darkened a little where the surface falls away, so that edges show.
Image raster_points(const std::vector<RasterPoint>& points, const RasterWindow& window, int width,
                    int height, int size, std::array<std::uint8_t, 3> background);

}  // namespace aims
