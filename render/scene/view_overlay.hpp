// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aims {

/// A dot in the world.
struct ViewPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();     ///< [m]
  std::array<std::uint8_t, 4> color{255, 255, 255, 255};  ///< sRGB and opacity
};

/// A line through points of the world.
struct ViewLine {
  std::vector<Eigen::Vector3f> points;                    ///< [m]
  std::array<std::uint8_t, 4> color{255, 255, 255, 255};  ///< sRGB and opacity
  float width = 1.5F;                                     ///< [px]
};

/// What a picture shows besides the model, hidden by what is nearer.
struct ViewOverlay {
  std::span<const ViewPoint> points;
  float point_diameter = 0.05F;  ///< [m]
  float least_diameter = 1.0F;   ///< of a point, however far away [px]
  std::vector<ViewLine> lines;
  std::array<float, 3> haze{};  ///< colour that points and lines fade to with their distance
  float haze_from = 1e6F;       ///< distance from the eye at which they begin to [m]
  float haze_to = 2e6F;         ///< at which nothing else is left [m]
};

/// Draws over the picture that the current OpenGL context has just made, through the same camera
/// and against the same depths. `focal_length`: pixels per metre at a distance of one metre.
void draw_overlay(const ViewOverlay& overlay, float focal_length);

}  // namespace aims
