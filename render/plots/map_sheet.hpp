// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "render/plots/map_picture.hpp"
#include "render/plots/plot.hpp"
#include "render/plots/point_raster.hpp"

namespace aims {

/// Strips of equal length, below one another, all at one scale.
struct MapLayout {
  int strips = 1;
  double scale = 1.0;  ///< [px/m]
  double width = 0.0;  ///< of a strip [px]
  double height = 0.0;
  double top = 64.0;  ///< of the first strip, with a subtitle of one line [px]

  static constexpr double kBetween = 58.0;  ///< below each strip, for its ticks [px]
  double total() const { return top + strips * (height + kBetween); }
};

/// Points and trajectory of a map picture in its plane, and where they are drawn.
struct MapSheet {
  MapView view;
  std::vector<RasterPoint> points;
  std::vector<Eigen::Vector2d> track;
  RasterWindow window;
  MapLayout layout;
  int point_size = 1;      ///< [px]
  bool squares = false;    ///< points as vector shapes
  std::size_t finite = 0;  ///< points of the map that are finite
  HeightRange heights;     ///< of the colours
};

/// The sheet of a picture whose strips are `width` wide [px]; with `squares` its points are the
/// smallest vector squares that are not too many.
MapSheet map_sheet(MapView view, const MapPicture& map, double width, bool squares);

/// The sheet of a map in one strip that shows `window`, `width` wide [px].
MapSheet map_sheet_of(MapView view, const MapPicture& map, const RasterWindow& window,
                      double width);

/// The part of the plane that a strip shows.
RasterWindow window_of(const MapSheet& sheet, int strip);

/// Draws points and trajectory of a strip into `area`, whose axes are the panel's.
void draw_strip(Canvas& canvas, const MapSheet& sheet, int strip, const Panel& panel,
                const Rect& area);

/// The nearest point of each cell of the strip's grid, with the cell as large as a point.
std::vector<RasterPoint> visible_points(const MapSheet& sheet, int strip);

}  // namespace aims
