// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/map_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/plots/map_sheet.hpp"
#include "render/plots/palette.hpp"
#include "render/plots/plot.hpp"

namespace aims {
namespace {

constexpr double kLeft = 84.0;    ///< margins around the strips [px]
constexpr double kRight = 150.0;  ///< with the colour scale
constexpr double kMargin = 28.0;  ///< right of the subtitle
void draw_strip(Canvas& canvas, const MapSheet& sheet, int strip) {
  const MapLayout& layout = sheet.layout;
  const RasterWindow part = window_of(sheet, strip);
  const Rect area{kLeft, layout.top + strip * (layout.height + MapLayout::kBetween), layout.width,
                  layout.height};
  Panel panel;
  panel.x = {strip + 1 == layout.strips ? "x [m]" : "", part.u_min, part.u_max};
  panel.y = {sheet.view == MapView::kAbove ? "y [m]" : "z [m]", part.v_min, part.v_max};
  draw_panel(canvas, area, panel);
  draw_strip(canvas, sheet, strip, panel, area);
}

std::string subtitle(const MapPicture& map, MapView view, std::size_t finite, int strips) {
  std::string text = view == MapView::kAbove
                         ? fmt::format("from above, cut open {:.1f} m over the floor", map.section)
                         : "from the side, looking along +y";
  text += fmt::format("  ·  {} points, {}, equal scales", finite, map.frame);
  if (strips > 1) text += fmt::format(", in {} consecutive strips", strips);
  if (finite < map.points.size())
    text += fmt::format("  ·  {} points are not finite", map.points.size() - finite);
  return text + "  ·  white: trajectory, dot: its start";
}

}  // namespace

Result<void> write_map_picture(const std::filesystem::path& path, MapView view,
                               const MapPicture& map) {
  MapSheet sheet = map_sheet(view, map, map.width - kLeft - kRight, path.extension() != ".png");
  const Heading heading(map.title, subtitle(map, view, sheet.finite, sheet.layout.strips),
                        map.width - kLeft - kMargin);
  sheet.layout.top += heading.extra_height();
  const int height = static_cast<int>(std::ceil(sheet.layout.total()));
  auto canvas = Canvas::create(path, map.width, height);
  if (!canvas) return tl::unexpected(canvas.error());
  heading.draw(*canvas, kLeft, 20.0);
  for (int strip = 0; strip < sheet.layout.strips; ++strip) draw_strip(*canvas, sheet, strip);
  if (sheet.finite == 0) {
    canvas->text(
        {kLeft + sheet.layout.width / 2.0, sheet.layout.top + sheet.layout.height / 2.0 - 24.0},
        "the map has no points",
        {.size = 20.0, .color = {0.9, 0.9, 0.9}, .horizontal = Align::kCenter});
  }
  const double bar = std::min(420.0, sheet.layout.total() - sheet.layout.top - MapLayout::kBetween);
  draw_color_bar(*canvas, {map.width - kRight + 42.0, sheet.layout.top, 18.0, bar},
                 {"height z [m]", sheet.heights.min, sheet.heights.max});
  return canvas->finish();
}

}  // namespace aims
