// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "render/plots/canvas.hpp"
#include "render/plots/ticks.hpp"

namespace aims {

struct Axis {
  std::string label;  ///< with the unit in square brackets
  double min = 0.0;
  double max = 1.0;
  bool logarithmic = false;
};

/// Smallest and largest of some values; empty until one is included.
struct Extent {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();

  void include(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
  }
  bool empty() const { return max < min; }
  double span() const { return max - min; }
  bool contains(double value) const { return value >= min && value <= max; }
  Extent widened(double margin) const { return {min - margin, max + margin}; }
};

/// Whether an axis can show the value.
bool is_shown(double value, bool logarithmic);

/// A line through data points; a non-finite point interrupts it.
struct Series {
  std::string name;  ///< in the legend; empty: not there
  std::vector<Eigen::Vector2d> points;
  Stroke stroke;
};

/// Stroke of style i (core/series_style.hpp).
Stroke series_stroke(std::size_t style, double width = 2.0);

/// Strokes of lines with those names: of estimators their own.
std::vector<Stroke> series_strokes(const std::vector<std::string>& names, double width = 2.0);

/// A labelled dot at a data point.
struct Mark {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::string label;
};

/// A labelled vertical line at a value of the x axis.
struct Event {
  double at = 0.0;
  std::string label;
};

/// One pair of axes and what is drawn between them, clipped to their ranges.
struct Panel {
  std::string title = {};
  Axis x = {};
  Axis y = {};
  std::vector<std::vector<Eigen::Vector2d>> areas = {};  ///< filled polygons, behind the lines
  std::vector<Series> series = {};
  std::vector<Mark> marks = {};
  std::vector<Event> events = {};
  double height = 1.0;      ///< of the drawing area [px] in a figure
  bool own_legend = false;  ///< list the series inside the panel, at the top right
};

/// Line and name of a legend entry.
struct LegendEntry {
  std::string name;
  Stroke stroke;
};

/// Panels below one another with a common title and legend.
struct Figure {
  std::string title = {};
  std::string subtitle = {};
  std::vector<LegendEntry> legend = {};
  std::vector<Panel> panels = {};
  int width = 1800;  ///< [px]; the height follows from the panels
};

/// The text in lines of at most that width [px], broken at spaces; a longer word is not broken.
std::vector<std::string> wrapped(const std::string& text, double width, const TextStyle& style);

/// A picture's title, and its subtitle in as many lines as the width takes.
struct Heading {
  std::string title;
  std::vector<std::string> lines;

  Heading(std::string title, const std::string& subtitle, double width);
  double extra_height() const;  ///< of all lines but the first [px]
  /// `left` is where the text begins [px]; the title stands `title_y` from the top.
  void draw(Canvas& canvas, double left, double title_y = 22.0) const;
};

/// Place of a value on an axis: 0 at its lower end, 1 at its upper.
double fraction_of(const Axis& axis, double value);

/// Pixel position of a data point when `axis` spans `area`; y of the canvas grows downwards.
Eigen::Vector2d to_pixels(const Panel& panel, const Rect& area, const Eigen::Vector2d& point);

/// Draws the panel's axes around `area` and its contents inside.
void draw_panel(Canvas& canvas, const Rect& area, const Panel& panel);

/// Draws the entries in rows that start at `top_left` and are at most `width` wide [px]; returns
/// the height taken [px].
double draw_legend(Canvas& canvas, const Eigen::Vector2d& top_left, double width,
                   const std::vector<LegendEntry>& entries);

/// Draws a vertical scale of `height_color` with ticks and the axis' label to the right of it.
void draw_color_bar(Canvas& canvas, const Rect& area, const Axis& axis);

/// Writes the figure to a .png, .svg or .pdf file.
Result<void> write_figure(const std::filesystem::path& path, const Figure& figure);

/// Widest drawing area [px] of the panels of a figure of that width.
double panel_width(int figure_width);

}  // namespace aims
