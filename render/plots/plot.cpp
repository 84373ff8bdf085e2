// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "render/plots/thinned_line.hpp"

namespace aims {
namespace {

constexpr double kLeftMargin = 84.0;
constexpr double kRightMargin = 28.0;
constexpr double kTickLength = 5.0;
constexpr double kLegendRow = 22.0;
constexpr double kPanelTop = 40.0;     ///< above a panel, for its title
constexpr double kPanelBottom = 50.0;  ///< below a panel, for ticks and label
constexpr double kSubtitleRow = 18.0;
const TextStyle kTitle{.size = 19.0, .bold = true};
const TextStyle kSubtitle{.size = 13.0, .color = {0.35, 0.35, 0.35}};
const Color kGrid{0.88, 0.88, 0.88};
const Color kFrame{0.25, 0.25, 0.25};
const Color kArea{0.80, 0.80, 0.80};

std::vector<Tick> ticks_of(const Axis& axis, double pixels, double spacing) {
  const int most = std::max(2, static_cast<int>(pixels / spacing));
  return axis.logarithmic ? logarithmic_ticks(axis.min, axis.max, most)
                          : linear_ticks(axis.min, axis.max, most);
}

void draw_x_axis(Canvas& canvas, const Rect& area, const Axis& axis) {
  const TextStyle style{.size = 13.0, .horizontal = Align::kCenter, .vertical = Align::kStart};
  for (const Tick& tick : ticks_of(axis, area.width, 90.0)) {
    const double x = area.x + area.width * fraction_of(axis, tick.value);
    canvas.line({{x, area.y}, {x, area.bottom()}}, {kGrid, 1.0});
    canvas.line({{x, area.bottom()}, {x, area.bottom() + kTickLength}}, {kFrame, 1.0});
    canvas.text({x, area.bottom() + 9.0}, tick.label, style);
  }
  canvas.text({area.x + area.width / 2.0, area.bottom() + 27.0}, axis.label, style);
}

void draw_y_axis(Canvas& canvas, const Rect& area, const Axis& axis) {
  for (const Tick& tick : ticks_of(axis, area.height, 34.0)) {
    const double y = area.bottom() - area.height * fraction_of(axis, tick.value);
    canvas.line({{area.x, y}, {area.right(), y}}, {kGrid, 1.0});
    canvas.line({{area.x - kTickLength, y}, {area.x, y}}, {kFrame, 1.0});
    canvas.text({area.x - 9.0, y}, tick.label, {.horizontal = Align::kEnd});
  }
  canvas.text({area.x - 62.0, area.y + area.height / 2.0}, axis.label,
              {.horizontal = Align::kCenter, .upwards = true});
}

void draw_events(Canvas& canvas, const Rect& area, const Panel& panel) {
  for (const Event& event : panel.events) {
    const double x = to_pixels(panel, area, {event.at, panel.y.max}).x();
    if (x < area.x || x > area.right()) continue;
    canvas.line({{x, area.y}, {x, area.bottom()}}, {{0.45, 0.45, 0.45}, 1.0, LineStyle::kDashed});
    const bool flip = x > area.right() - 30.0;
    const double width = canvas.text_width(event.label, {.bold = true});
    canvas.fill(Rect{flip ? x - 9.0 - width : x + 3.0, area.y + 4.0, width + 6.0, 18.0},
                {1.0, 1.0, 1.0, 0.75});
    canvas.text({flip ? x - 6.0 : x + 6.0, area.y + 13.0}, event.label,
                {.horizontal = flip ? Align::kEnd : Align::kStart, .bold = true});
  }
}

void draw_marks(Canvas& canvas, const Rect& area, const Panel& panel) {
  for (const Mark& mark : panel.marks) {
    const Eigen::Vector2d at = to_pixels(panel, area, mark.at);
    canvas.disc(at, 6.0, {1.0, 1.0, 1.0});
    canvas.disc(at, 4.5, {0.0, 0.0, 0.0});
    const double width = canvas.text_width(mark.label, {.size = 16.0, .bold = true});
    const double half = std::min(width / 2.0 + 4.0, area.width / 2.0);
    const bool below = at.y() - 29.0 < area.y;
    const Eigen::Vector2d label(std::clamp(at.x(), area.x + half, area.right() - half),
                                at.y() + (below ? 19.0 : -19.0));
    canvas.fill({label.x() - width / 2.0 - 4.0, label.y() - 10.0, width + 8.0, 20.0},
                {1.0, 1.0, 1.0, 0.8});
    canvas.text(label, mark.label, {.size = 16.0, .horizontal = Align::kCenter, .bold = true});
  }
}

void draw_own_legend(Canvas& canvas, const Rect& area, const Panel& panel) {
  std::vector<LegendEntry> entries;
  double width = 0.0;
  for (const Series& series : panel.series) {
    if (series.name.empty()) continue;
    entries.push_back({series.name, series.stroke});
    width += canvas.text_width(series.name, {}) + 66.0;
  }
  if (entries.empty()) return;
  width = std::min(width, area.width);
  draw_legend(canvas, {area.right() - width, area.y - 30.0}, width + 60.0, entries);
}

/// A line without a dot at its end: the break separates enough.
std::string without_separator(std::string line) {
  constexpr std::string_view kMiddleDot = "\u00b7";
  if (line.ends_with(kMiddleDot)) line.resize(line.size() - kMiddleDot.size());
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace

Stroke series_stroke(std::size_t style, double width) {
  return {series_color(style), width, series_style(style).pattern};
}

std::vector<Stroke> series_strokes(const std::vector<std::string>& names, double width) {
  std::vector<Stroke> strokes;
  for (const std::size_t style : series_styles(names)) {
    strokes.push_back(series_stroke(style, width));
  }
  return strokes;
}

bool is_shown(double value, bool logarithmic) {
  return std::isfinite(value) && (!logarithmic || value > 0.0);
}

double fraction_of(const Axis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.min) / (axis.max - axis.min);
  if (!(value > 0.0)) return -std::numeric_limits<double>::infinity();
  return std::log(value / axis.min) / std::log(axis.max / axis.min);
}

std::vector<std::string> wrapped(const std::string& text, double width, const TextStyle& style) {
  Canvas ruler = Canvas::over(Image(1, 1));
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t begin = 0; begin < text.size();) {
    // A word with the spaces before it, which go when it begins a line.
    const std::size_t word = std::min(text.find_first_not_of(' ', begin), text.size());
    const std::size_t end = std::min(text.find(' ', word), text.size());
    const std::string longer = line + text.substr(begin, end - begin);
    if (!line.empty() && ruler.text_width(longer, style) > width) {
      lines.push_back(without_separator(std::exchange(line, text.substr(word, end - word))));
      line = without_separator(line);
    } else if (line.empty()) {
      line = text.substr(word, end - word);
    } else {
      line = longer;
    }
    begin = end;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

Heading::Heading(std::string text, const std::string& subtitle, double width)
    : title(std::move(text)), lines(wrapped(subtitle, width, kSubtitle)) {}

double Heading::extra_height() const {
  return lines.empty() ? 0.0 : kSubtitleRow * static_cast<double>(lines.size() - 1);
}

void Heading::draw(Canvas& canvas, double left, double title_y) const {
  canvas.text({left, title_y}, title, kTitle);
  double y = title_y + 24.0;
  for (const std::string& line : lines) {
    canvas.text({left, y}, line, kSubtitle);
    y += kSubtitleRow;
  }
}

double panel_width(int figure_width) { return figure_width - kLeftMargin - kRightMargin; }

Eigen::Vector2d to_pixels(const Panel& panel, const Rect& area, const Eigen::Vector2d& point) {
  // Far outside, positions are cut so that the drawing library keeps its precision.
  const double x = std::clamp(fraction_of(panel.x, point.x()), -20.0, 20.0);
  const double y = std::clamp(fraction_of(panel.y, point.y()), -20.0, 20.0);
  return {area.x + area.width * x, area.bottom() - area.height * y};
}

void draw_panel(Canvas& canvas, const Rect& area, const Panel& panel) {
  draw_x_axis(canvas, area, panel.x);
  draw_y_axis(canvas, area, panel.y);
  canvas.clip(area);
  const auto pixels = [&](const std::vector<Eigen::Vector2d>& points) {
    std::vector<Eigen::Vector2d> result;
    result.reserve(points.size());
    for (const Eigen::Vector2d& point : points) {
      result.push_back(point.allFinite() ? to_pixels(panel, area, point) : point);
    }
    return result;
  };
  for (const auto& corners : panel.areas) {
    std::vector<Eigen::Vector2d> outline = pixels(corners);
    canvas.fill(outline, kArea);
    if (!outline.empty()) outline.push_back(outline.front());
    canvas.line(outline, {kArea, 0.8});  // closes the seams between neighbours
  }
  for (const Series& series : panel.series) {
    canvas.line(thinned_line(pixels(series.points)), series.stroke);
  }
  draw_marks(canvas, area, panel);
  canvas.unclip();
  draw_events(canvas, area, panel);
  canvas.outline(area, {kFrame, 1.0});
  canvas.text({area.x, area.y - 16.0}, panel.title, {.size = 14.0, .bold = true});
  if (panel.own_legend) draw_own_legend(canvas, area, panel);
}

double draw_legend(Canvas& canvas, const Eigen::Vector2d& top_left, double width,
                   const std::vector<LegendEntry>& entries) {
  constexpr double kSample = 34.0;
  Eigen::Vector2d at = top_left + Eigen::Vector2d(0.0, kLegendRow / 2.0);
  for (const LegendEntry& entry : entries) {
    const double text = canvas.text_width(entry.name, {});
    if (at.x() > top_left.x() && at.x() + kSample + 8.0 + text > top_left.x() + width) {
      at = {top_left.x(), at.y() + kLegendRow};
    }
    Stroke stroke = entry.stroke;
    stroke.width = std::max(stroke.width, 2.5);
    canvas.line({at, at + Eigen::Vector2d(kSample, 0.0)}, stroke);
    canvas.text(at + Eigen::Vector2d(kSample + 8.0, 0.0), entry.name, {});
    at.x() += kSample + 8.0 + text + 24.0;
  }
  return entries.empty() ? 0.0 : at.y() - top_left.y() + kLegendRow / 2.0;
}

void draw_color_bar(Canvas& canvas, const Rect& area, const Axis& axis) {
  Image scale(1, 256);
  const auto table = height_table();
  for (int row = 0; row < 256; ++row) scale.set(0, row, table[static_cast<std::size_t>(255 - row)]);
  canvas.image(scale, area);
  canvas.outline(area, {kFrame, 1.0});
  for (const Tick& tick : ticks_of(axis, area.height, 40.0)) {
    const double y = area.bottom() - area.height * fraction_of(axis, tick.value);
    canvas.line({{area.right(), y}, {area.right() + kTickLength, y}}, {kFrame, 1.0});
    canvas.text({area.right() + 9.0, y}, tick.label, {});
  }
  canvas.text({area.right() + 62.0, area.y + area.height / 2.0}, axis.label,
              {.horizontal = Align::kCenter, .upwards = true});
}

Result<void> write_figure(const std::filesystem::path& path, const Figure& figure) {
  constexpr double kHeader = 34.0;
  const double width = panel_width(figure.width);
  const Heading heading(figure.title, figure.subtitle, width);
  const double subtitle = heading.lines.empty() ? 0.0 : 22.0 + heading.extra_height();
  // The legend needs at most two rows for the estimators of one run.
  const double legend = figure.legend.empty() ? 0.0 : (figure.legend.size() > 7 ? 2.0 : 1.0) * 24.0;
  double height = kHeader + subtitle + legend + 8.0;
  for (const Panel& panel : figure.panels) height += kPanelTop + panel.height + kPanelBottom;
  auto canvas = Canvas::create(path, figure.width, static_cast<int>(std::ceil(height)));
  if (!canvas) return tl::unexpected(canvas.error());
  heading.draw(*canvas, kLeftMargin);
  draw_legend(*canvas, {kLeftMargin, kHeader + subtitle + 4.0}, width, figure.legend);
  double y = kHeader + subtitle + legend + 8.0;
  for (const Panel& panel : figure.panels) {
    draw_panel(*canvas, {kLeftMargin, y + kPanelTop, width, panel.height}, panel);
    y += kPanelTop + panel.height + kPanelBottom;
  }
  return canvas->finish();
}

}  // namespace aims
