// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/roc_plot.hpp"

#include <algorithm>

#include "render/plots/plot.hpp"

namespace aims {
namespace {

constexpr double kLegendTop = 56.0;  ///< below a panel [px]
constexpr double kLegendRow = 24.0;  ///< [px]
constexpr std::size_t kColors = 6;   ///< of the palette, before the line style changes

Stroke stroke_of(std::size_t detector) {
  constexpr LineStyle kStyles[] = {LineStyle::kSolid, LineStyle::kDashed, LineStyle::kDashDotted};
  return {series_color(detector % kColors), 2.2, kStyles[(detector / kColors) % 3]};
}

Panel panel_of(const RocPanel& source) {
  Panel panel;
  panel.title = source.title;
  panel.x = {"false-alarm rate [-]", -0.02, 1.02, false};
  panel.y = {"detection rate [-]", -0.02, 1.02, false};
  panel.series.push_back(
      {"", {{0.0, 0.0}, {1.0, 1.0}}, {{0.45, 0.45, 0.45}, 1.2, LineStyle::kDotted}});
  for (std::size_t i = 0; i < source.series.size(); ++i) {
    panel.series.push_back({source.series[i].name, source.series[i].points, stroke_of(i)});
  }
  return panel;
}

void draw(Canvas& canvas, const Rect& area, const RocPanel& source) {
  draw_panel(canvas, area, panel_of(source));
  if (source.series.empty()) {
    canvas.text({area.x + 0.5 * area.width, area.y + 0.25 * area.height}, "no event to detect",
                {.size = 15.0, .horizontal = Align::kCenter});
  }
  double y = area.bottom() + kLegendTop;
  for (std::size_t i = 0; i < source.series.size(); ++i) {
    y += draw_legend(canvas, {area.x, y}, area.width, {{source.series[i].name, stroke_of(i)}});
  }
}

}  // namespace

Result<void> write_roc_plot(const std::filesystem::path& path, const RocPlot& plot) {
  std::size_t rows = 0;
  for (const RocPanel& panel : plot.panels) rows = std::max(rows, panel.series.size());
  const PanelRow row{.title = plot.title,
                     .subtitle = plot.subtitle,
                     .panels = plot.panels.size(),
                     .pitch = 510.0,
                     .below = kLegendTop + static_cast<double>(rows) * kLegendRow + 16.0};
  return write_panel_row(path, row, [&](Canvas& canvas, std::size_t i, const Rect& area) {
    draw(canvas, area, plot.panels[i]);
  });
}

}  // namespace aims
