// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/map_grid.hpp"

#include <algorithm>
#include <cmath>

#include "render/plots/map_sheet.hpp"

namespace aims {
namespace {

constexpr double kLeft = 84.0;     ///< of the first column [px]
constexpr double kRight = 140.0;   ///< with the colour scale
constexpr double kTop = 92.0;      ///< above the first panel, with its title
constexpr double kBetween = 62.0;  ///< below each panel: ticks, and the next title
constexpr double kGap = 100.0;     ///< between columns
constexpr double kAround = 6.0;    ///< shown around the truth on the ground [m]
constexpr double kBelow = 2.5;     ///< below and above its heights
constexpr double kAbove = 4.0;
constexpr double kElongated = 3.0;  ///< from this ratio of the sides on, a map fills a row

/// What lies around the truth.
struct Surroundings {
  RasterWindow above;
  RasterWindow side;
  HeightRange heights;
};

Surroundings surroundings(const Trajectory& truth) {
  Extent x;
  Extent y;
  Extent z;
  for (const StampedPose& sample : truth) {
    x.include(sample.pose.translation.x());
    y.include(sample.pose.translation.y());
    z.include(sample.pose.translation.z());
  }
  const Extent along = x.widened(kAround);
  const Extent across = y.widened(kAround);
  return {{along.min, along.max, across.min, across.max},
          {along.min, along.max, z.min - kBelow, z.max + kAbove},
          {z.min - 1.0, z.max + 2.5}};
}

/// Where the panels of one view stand.
struct Block {
  MapView view;
  RasterWindow window;
  int columns;
  double top;
  double width;  ///< of a panel [px]

  double height() const {
    return std::round(width * (window.v_max - window.v_min) / (window.u_max - window.u_min));
  }
  Rect area(std::size_t i) const {
    const auto column = static_cast<double>(i % static_cast<std::size_t>(columns));
    const auto row = static_cast<double>(i / static_cast<std::size_t>(columns));
    return {kLeft + column * (width + kGap), top + row * (height() + kBetween), width, height()};
  }
  double bottom(std::size_t maps) const { return area(maps - 1).bottom() + kBetween; }
};

Block block_of(MapView view, const RasterWindow& window, double top, int picture_width) {
  const bool elongated = (window.u_max - window.u_min) > kElongated * (window.v_max - window.v_min);
  const int columns = view == MapView::kAbove && elongated ? 1 : 2;
  const double width = picture_width - kLeft - kRight - (columns - 1) * kGap;
  return {view, window, columns, top, std::floor(width / columns)};
}

void draw_map(Canvas& canvas, const MapPicture& map, const Block& block, std::size_t i) {
  const Rect area = block.area(i);
  const MapSheet sheet = map_sheet_of(block.view, map, block.window, block.width);
  Panel panel;
  panel.title = map.title + (block.view == MapView::kAbove ? ", from above" : ", from the side");
  panel.x = {"", block.window.u_min, block.window.u_max};
  panel.y = {block.view == MapView::kAbove ? "y [m]" : "z [m]", block.window.v_min,
             block.window.v_max};
  draw_panel(canvas, area, panel);
  draw_strip(canvas, sheet, 0, panel, area);
}

}  // namespace

Result<void> write_map_grid(const std::filesystem::path& path, const MapGrid& grid) {
  if (grid.maps.empty() || grid.truth.empty()) {
    return failure(path.string() + ": expected maps and a truth");
  }
  const Surroundings shown = surroundings(grid.truth);
  const Heading heading(grid.title, grid.subtitle, grid.width - 2.0 * kLeft);
  const double top = kTop + heading.extra_height();
  const Block above = block_of(MapView::kAbove, shown.above, top, grid.width);
  const Block side =
      block_of(MapView::kSide, shown.side, above.bottom(grid.maps.size()), grid.width);
  const double height = side.bottom(grid.maps.size());
  auto canvas = Canvas::create(path, grid.width, static_cast<int>(std::ceil(height)));
  if (!canvas) return tl::unexpected(canvas.error());
  heading.draw(*canvas, kLeft, 20.0);
  for (const Block& block : {above, side}) {
    for (std::size_t i = 0; i < grid.maps.size(); ++i) {
      MapPicture map = grid.maps[i];
      map.heights = shown.heights;
      draw_map(*canvas, map, block, i);
    }
  }
  draw_color_bar(*canvas, {grid.width - kRight + 42.0, top, 18.0, std::min(420.0, height - top)},
                 {"height z [m]", shown.heights.min, shown.heights.max});
  return canvas->finish();
}

}  // namespace aims
