// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/palette.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/series_style.hpp"

namespace aims {
namespace {

/// Linear-light sRGB of an Oklab colour; components outside [0, 1] mean that there is none.
Eigen::Vector3d linear_srgb(double lightness, double a, double b) {
  Eigen::Matrix3d to_cone_roots;
  to_cone_roots << 1.0, 0.3963377774, 0.2158037573,  //
      1.0, -0.1055613458, -0.0638541728,             //
      1.0, -0.0894841775, -1.2914855480;
  Eigen::Matrix3d to_rgb;
  to_rgb << 4.0767416621, -3.3077115913, 0.2309699292,  //
      -1.2684380046, 2.6097574011, -0.3413193965,       //
      -0.0041960863, -0.7034186147, 1.7076147010;
  const Eigen::Vector3d roots = to_cone_roots * Eigen::Vector3d(lightness, a, b);
  return to_rgb * roots.array().cube().matrix();
}

double gamma_encoded(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
}

std::uint8_t byte_of(double component) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(component, 0.0, 1.0)));
}

}  // namespace

Color oklch_color(double lightness, double chroma, double hue_deg) {
  const double hue = hue_deg * std::numbers::pi / 180.0;
  Eigen::Vector3d rgb = Eigen::Vector3d::Zero();
  for (double c = chroma; c > -1e-9; c -= 0.002) {
    rgb = linear_srgb(lightness, c * std::cos(hue), c * std::sin(hue));
    if (rgb.minCoeff() >= 0.0 && rgb.maxCoeff() <= 1.0) break;
  }
  return {gamma_encoded(rgb.x()), gamma_encoded(rgb.y()), gamma_encoded(rgb.z())};
}

Color height_color(double fraction) {
  const double t = std::clamp(std::isfinite(fraction) ? fraction : 0.0, 0.0, 1.0);
  return oklch_color(0.42 + 0.50 * t, 0.15, 308.0 - 203.0 * t);
}

std::array<std::array<std::uint8_t, 3>, 256> height_table() {
  std::array<std::array<std::uint8_t, 3>, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Color color = height_color(static_cast<double>(i) / 255.0);
    table[i] = {byte_of(color.red), byte_of(color.green), byte_of(color.blue)};
  }
  return table;
}

Color series_color(std::size_t index) {
  const std::uint32_t rgb = series_style(index).light;
  return {(rgb >> 16U & 0xFFU) / 255.0, (rgb >> 8U & 0xFFU) / 255.0, (rgb & 0xFFU) / 255.0};
}

}  // namespace aims
