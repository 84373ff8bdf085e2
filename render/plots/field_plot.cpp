// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/field_plot.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/plots/palette.hpp"

namespace aims {
namespace {

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

/// The cell's value where the scale can show it.
std::optional<double> shown_value(const FieldCell& cell, bool logarithmic) {
  return cell.value && is_shown(*cell.value, logarithmic) ? cell.value : std::nullopt;
}

/// The scale that all panels share.
Axis value_axis(const FieldPlot& plot) {
  Extent extent;
  for (const FieldPanel& panel : plot.panels) {
    for (const FieldCell& cell : panel.cells) {
      if (const auto value = shown_value(cell, plot.logarithmic_value)) extent.include(*value);
    }
  }
  if (extent.empty()) extent = {1.0, 1.0};
  if (!(extent.min < extent.max)) {
    extent =
        plot.logarithmic_value ? Extent{0.9 * extent.min, 1.1 * extent.max} : extent.widened(0.5);
  }
  return {plot.value_label, extent.min, extent.max, plot.logarithmic_value};
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
    const auto value = shown_value(cell, plot.logarithmic_value);
    canvas.fill(rect, value ? height_color(fraction_of(scale, *value)) : kNothing);
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
  const PanelRow row{.title = plot.title,
                     .subtitle = plot.subtitle,
                     .panels = plot.panels.size(),
                     .right = 110.0,
                     .min_width = 700.0};
  const Axis scale = value_axis(plot);
  return write_panel_row(path, row, [&](Canvas& canvas, std::size_t i, const Rect& area) {
    const Panel frame = frame_of(plot, plot.panels[i]);
    draw_cells(canvas, area, frame, plot.panels[i], plot, scale);
    draw_panel(canvas, area, frame);
    if (i + 1 < plot.panels.size()) return;
    draw_color_bar(canvas, {area.right() + 24.0, area.y, 18.0, area.height}, scale);
  });
}

}  // namespace aims
