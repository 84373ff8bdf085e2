// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace aims {

/// Colour with components in [0, 1] (sRGB).
struct Color {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
  double alpha = 1.0;
};

/// Colour of a Hue-Lightness-Chroma triple of the Oklab space (B. Ottosson, 2020), with chroma
/// lowered until the colour exists in sRGB. Lightness and chroma in [0, 1], hue in degrees.
Color oklch_color(double lightness, double chroma, double hue_deg);

/// Perceptually ordered colour of a height, 0 = lowest to 1 = highest (clamped): lightness grows
/// evenly from violet over blue and green to yellow, so that the order survives colour blindness
/// and grey print.
Color height_color(double fraction);

/// `height_color` as 256 pixels' values, lowest first.
std::array<std::array<std::uint8_t, 3>, 256> height_table();

/// Colour of style i on white (core/series_style.hpp).
Color series_color(std::size_t index);

}  // namespace aims
