// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/field_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/plots/palette.hpp"

namespace aims {
namespace {

constexpr double kSide = 400.0;        ///< of a panel [px]
constexpr double kPanelPitch = 490.0;  ///< from panel to panel [px]
constexpr double kLeft = 84.0;         ///< of the first panel [px]
constexpr double kTop = 104.0;         ///< of the panels [px]
constexpr double kBelow = 64.0;        ///< [px]
constexpr double kBar = 18.0;          ///< width of the scale [px]
constexpr double kRight = 110.0;       ///< for the scale and its label [px]
constexpr double kMargin = 28.0;       ///< right of the subtitle [px]
constexpr Color kNothing{0.85, 0.85, 0.85};

/// Borders of the cells around sorted centres, halfway to the neighbours on the axis' scale.
std::vector<double> borders_of(const std::vector<double>& centres, bool logarithmic) {
  const auto to = [&](double value) { return logarithmic ? std::log(value) : value; };
  const auto back = [&](double value) { return logarithmic ? std::exp(value) : value; };
  std::vector<double> borders;
  if (centres.size() < 2) {
    const double at = centres.empty() ? 1.0 : centres.front();
    return {back(to(at) - 0.5), back(to(at) + 0.5)};
  }
  const auto halfway = [&](std::size_t i, std::size_t k) {
    return 0.5 * (to(centres[i]) + to(centres[k]));
  };
  const std::size_t last = centres.size() - 1;
  borders.push_back(back(2.0 * to(centres[0]) - halfway(0, 1)));
  for (std::size_t i = 0; i < last; ++i) borders.push_back(back(halfway(i, i + 1)));
  borders.push_back(back(2.0 * to(centres[last]) - halfway(last - 1, last)));
  return borders;
}

std::vector<double> sorted_values(const std::vector<FieldCell>& cells, double FieldCell::*member) {
  std::vector<double> values;
  for (const FieldCell& cell : cells) values.push_back(cell.*member);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

bool is_shown(const FieldCell& cell, bool logarithmic) {
  return cell.value && std::isfinite(*cell.value) && (!logarithmic || *cell.value > 0.0);
}

/// The scale that all panels share.
Axis value_axis(const FieldPlot& plot) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const FieldPanel& panel : plot.panels) {
    for (const FieldCell& cell : panel.cells) {
      if (!is_shown(cell, plot.logarithmic_value)) continue;
      low = std::min(low, *cell.value);
      high = std::max(high, *cell.value);
    }
  }
  if (!(low < high)) {
    const double at = low <= high ? low : 1.0;
    low = plot.logarithmic_value ? 0.9 * at : at - 0.5;
    high = plot.logarithmic_value ? 1.1 * at : at + 0.5;
  }
  return {plot.value_label, low, high, plot.logarithmic_value};
}

double fraction(const Axis& axis, double value) {
  if (axis.logarithmic) return std::log(value / axis.min) / std::log(axis.max / axis.min);
  return (value - axis.min) / (axis.max - axis.min);
}

void draw_cells(Canvas& canvas, const Rect& area, const Panel& frame, const FieldPanel& source,
                const FieldPlot& plot, const Axis& scale) {
  const auto columns = sorted_values(source.cells, &FieldCell::x);
  const auto rows = sorted_values(source.cells, &FieldCell::y);
  const auto x = borders_of(columns, plot.logarithmic_x);
  const auto y = borders_of(rows, plot.logarithmic_y);
  canvas.clip(area);
  for (const FieldCell& cell : source.cells) {
    const auto i = static_cast<std::size_t>(
        std::lower_bound(columns.begin(), columns.end(), cell.x) - columns.begin());
    const auto k =
        static_cast<std::size_t>(std::lower_bound(rows.begin(), rows.end(), cell.y) - rows.begin());
    const Eigen::Vector2d low = to_pixels(frame, area, {x[i], y[k]});
    const Eigen::Vector2d high = to_pixels(frame, area, {x[i + 1], y[k + 1]});
    // Half a pixel more on each side closes the seams between neighbours.
    const Rect rect{low.x() - 0.5, high.y() - 0.5, high.x() - low.x() + 1.0,
                    low.y() - high.y() + 1.0};
    const bool shown = is_shown(cell, plot.logarithmic_value);
    canvas.fill(rect, shown ? height_color(fraction(scale, *cell.value)) : kNothing);
  }
  canvas.unclip();
}

Panel frame_of(const FieldPlot& plot, const FieldPanel& source) {
  const auto x = borders_of(sorted_values(source.cells, &FieldCell::x), plot.logarithmic_x);
  const auto y = borders_of(sorted_values(source.cells, &FieldCell::y), plot.logarithmic_y);
  Panel panel;
  panel.title = source.title;
  panel.x = {plot.x_label, x.front(), x.back(), plot.logarithmic_x};
  panel.y = {plot.y_label, y.front(), y.back(), plot.logarithmic_y};
  panel.marks = plot.marks;
  return panel;
}

}  // namespace

Result<void> write_field_plot(const std::filesystem::path& path, const FieldPlot& plot) {
  const auto panels = static_cast<double>(std::max<std::size_t>(1, plot.panels.size()));
  const double width = std::max(kLeft + panels * kPanelPitch + kRight - 60.0, 700.0);
  const Heading heading(plot.title, plot.subtitle, width - kLeft - kMargin);
  const double top = kTop + heading.extra_height();
  auto canvas =
      Canvas::create(path, static_cast<int>(width), static_cast<int>(top + kSide + kBelow));
  if (!canvas) return tl::unexpected(canvas.error());
  heading.draw(*canvas, kLeft);
  const Axis scale = value_axis(plot);
  double x = kLeft;
  for (const FieldPanel& panel : plot.panels) {
    const Rect area{x, top, kSide, kSide};
    const Panel frame = frame_of(plot, panel);
    draw_cells(*canvas, area, frame, panel, plot, scale);
    draw_panel(*canvas, area, frame);
    x += kPanelPitch;
  }
  draw_color_bar(*canvas, {x - kPanelPitch + kSide + 24.0, top, kBar, kSide}, scale);
  return canvas->finish();
}

}  // namespace aims
