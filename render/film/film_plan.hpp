// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "render/plots/canvas.hpp"
#include "render/plots/point_raster.hpp"

namespace aims {

/// A small plan of the whole sequence in a corner of a film's pictures, on which the map grows.
class FilmPlan {
 public:
  /// For pictures of that size [px]; the plan shows where `path` is. Points of
  /// `height` in [0, 1] as colour; in order of time.
  FilmPlan(std::vector<RasterPoint> points, std::span<const Eigen::Vector2d> path, int width,
           int height);

  /// Where it is drawn [px].
  const Rect& area() const { return area_; }

  /// Draws the first `count` points and the robot with its heading [rad].
  void draw(Canvas& canvas, std::size_t count, const Eigen::Vector2d& robot, double heading) const;

 private:
  Eigen::Vector2d to_pixels(const Eigen::Vector2d& point) const;

  std::vector<RasterPoint> points_;
  RasterWindow window_;
  Rect area_;
  double unit_ = 1.0;  ///< [px] that lines and letters are multiples of
};

}  // namespace aims
