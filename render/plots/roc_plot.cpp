// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/roc_plot.hpp"

#include <algorithm>

#include "render/plots/plot.hpp"

namespace aims {
namespace {

constexpr double kSide = 400.0;        ///< of a panel [px]
constexpr double kPanelPitch = 510.0;  ///< from panel to panel [px]
constexpr double kLeft = 84.0;         ///< of the first panel [px]
constexpr double kTop = 104.0;         ///< of the panels [px]
constexpr double kLegendTop = 56.0;    ///< below a panel [px]
constexpr double kLegendRow = 24.0;    ///< [px]
constexpr std::size_t kColors = 6;     ///< of the palette, before the line style changes

Stroke stroke_of(std::size_t detector) {
  constexpr LineStyle kStyles[] = {LineStyle::kSolid, LineStyle::kDashed, LineStyle::kDashDotted};
  return {series_color(detector % kColors), 2.2, kStyles[(detector / kColors) % 3]};
}

Panel panel_of(const RocPanel& source) {
  Panel panel;
  panel.title = source.title;
  panel.x = {"false alarms [share of sound scans]", -0.02, 1.02, false};
  panel.y = {"detections [share of degenerate scans]", -0.02, 1.02, false};
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
    canvas.text({area.x + 0.5 * area.width, area.y + 0.25 * area.height}, "nothing to detect",
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
  const auto panels = static_cast<double>(std::max<std::size_t>(1, plot.panels.size()));
  const double width = kLeft + panels * kPanelPitch - 60.0;
  const Heading heading(plot.title, plot.subtitle, width - kLeft - 28.0);
  const double top = kTop + heading.extra_height();
  const double height = top + kSide + kLegendTop + static_cast<double>(rows) * kLegendRow + 16.0;
  auto canvas = Canvas::create(path, static_cast<int>(width), static_cast<int>(height));
  if (!canvas) return tl::unexpected(canvas.error());
  heading.draw(*canvas, kLeft);
  double x = kLeft;
  for (const RocPanel& panel : plot.panels) {
    draw(*canvas, {x, top, kSide, kSide}, panel);
    x += kPanelPitch;
  }
  return canvas->finish();
}

}  // namespace aims
