// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/point_raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/plots/palette.hpp"

namespace aims {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();

struct Raster {
  int width = 0;
  int height = 0;
  std::vector<float> nearness;
  std::vector<std::uint8_t> color;

  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }

  void put(int column, int row, int size, float near_value, std::uint8_t color_index) {
    for (int y = std::max(0, row); y < std::min(height, row + size); ++y) {
      for (int x = std::max(0, column); x < std::min(width, column + size); ++x) {
        const std::size_t i = at(x, y);
        if (nearness[i] >= near_value) continue;
        nearness[i] = near_value;
        color[i] = color_index;
      }
    }
  }
};

/// Brightness in [0.55, 1] of a pixel whose neighbours two pixels away are nearer.
double brightness(const Raster& raster, int column, int row) {
  constexpr double kDepth = 0.6;  // fall that darkens to 1/e [m]
  const float here = raster.nearness[raster.at(column, row)];
  double fall = 0.0;
  const int left = std::max(0, column - 2);
  const int right = std::min(raster.width - 1, column + 2);
  const int top = std::max(0, row - 2);
  const int bottom = std::min(raster.height - 1, row + 2);
  for (const std::size_t i : {raster.at(left, row), raster.at(right, row), raster.at(column, top),
                              raster.at(column, bottom)}) {
    if (raster.nearness[i] > here) fall += 0.25 * std::min(2.0F, raster.nearness[i] - here);
  }
  return 0.55 + 0.45 * std::exp(-fall / kDepth);
}

Image shaded(const Raster& raster, const std::array<std::uint8_t, 3>& background) {
  const auto table = height_table();
  Image image(raster.width, raster.height);
  for (int row = 0; row < raster.height; ++row) {
    for (int column = 0; column < raster.width; ++column) {
      const std::size_t i = raster.at(column, row);
      if (raster.nearness[i] == kNothing) {
        image.set(column, row, background);
        continue;
      }
      const double light = brightness(raster, column, row);
      std::array<std::uint8_t, 3> color = table[raster.color[i]];
      for (std::uint8_t& value : color) value = static_cast<std::uint8_t>(light * value + 0.5);
      image.set(column, row, color);
    }
  }
  return image;
}

}  // namespace

Image raster_points(const std::vector<RasterPoint>& points, const RasterWindow& window, int width,
                    int height, int size, std::array<std::uint8_t, 3> background) {
  Raster raster{width, height, {}, {}};
  const std::size_t pixels = raster.at(0, height);
  raster.nearness.assign(pixels, kNothing);
  raster.color.assign(pixels, 0);
  const double per_u = width / (window.u_max - window.u_min);
  const double per_v = height / (window.v_max - window.v_min);
  for (const RasterPoint& point : points) {
    if (point.u < window.u_min || point.u > window.u_max || point.v < window.v_min ||
        point.v > window.v_max) {
      continue;
    }
    const int column = static_cast<int>((point.u - window.u_min) * per_u) - (size - 1) / 2;
    const int row = static_cast<int>((window.v_max - point.v) * per_v) - (size - 1) / 2;
    const double shade = std::clamp(point.height, 0.0F, 1.0F);
    raster.put(column, row, size, point.nearness, static_cast<std::uint8_t>(255.0 * shade + 0.5));
  }
  return shaded(raster, background);
}

}  // namespace aims
