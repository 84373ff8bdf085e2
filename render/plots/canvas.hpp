// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/series_style.hpp"
#include "render/plots/image.hpp"
#include "render/plots/palette.hpp"

namespace aims {

/// Area of a canvas [px]; y grows downwards.
struct Rect {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
};

using LineStyle = LinePattern;

struct Stroke {
  Color color;
  double width = 1.5;  ///< [px]
  LineStyle style = LineStyle::kSolid;
};

enum class Align { kStart, kCenter, kEnd };  ///< left, centre, right; or top, middle, bottom

struct TextStyle {
  double size = 13.0;  ///< [px]
  Color color{0.13, 0.13, 0.13};
  Align horizontal = Align::kStart;
  Align vertical = Align::kCenter;
  bool bold = false;
  bool upwards = false;  ///< reads from bottom to top
};

/// Surface for lines, areas, pixels and text that becomes a PNG, SVG or PDF file, by the ending
/// of its name. The file appears complete with `finish`; without it nothing is left behind.
class Canvas {
 public:
  /// Error for an unknown ending or a path that cannot be written.
  static Result<Canvas> create(const std::filesystem::path& path, int width, int height,
                               Color background = {1.0, 1.0, 1.0});
  /// A canvas over `picture` that becomes no file: `pixels` gives what was drawn.
  static Canvas over(const Image& picture);
  Canvas(Canvas&&) noexcept;
  Canvas& operator=(Canvas&&) noexcept;
  ~Canvas();

  void fill(const Rect& area, Color color);
  void outline(const Rect& area, const Stroke& stroke);
  /// A polygon given by its corners [px].
  void fill(const std::vector<Eigen::Vector2d>& corners, Color color);
  /// Line through the points [px]; a non-finite point interrupts it.
  void line(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke);
  /// Squares of `size` around the points [px], as one shape.
  void squares(const std::vector<Eigen::Vector2d>& centers, double size, Color color);
  void disc(const Eigen::Vector2d& center, double radius, Color color);
  void text(const Eigen::Vector2d& at, const std::string& text, const TextStyle& style);
  double text_width(const std::string& text, const TextStyle& style);  ///< [px]
  /// Draws `image` stretched over `area`, without smoothing.
  void image(const Image& image, const Rect& area);
  /// Nothing is drawn outside `area` until `unclip`.
  void clip(const Rect& area);
  void unclip();

  /// What was drawn so far; empty for .svg and .pdf.
  Image pixels() const;

  /// Writes the file. Error when it cannot be written.
  Result<void> finish();

 private:
  struct Impl;
  explicit Canvas(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
