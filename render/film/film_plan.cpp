// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/film_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kMargin = 2.0;  ///< around the trajectory [m]
constexpr std::array<std::uint8_t, 3> kGround = {13, 15, 20};

RasterWindow window_around(std::span<const Eigen::Vector2d> path) {
  RasterWindow window{1e9, -1e9, 1e9, -1e9};
  for (const Eigen::Vector2d& point : path) {
    window.u_min = std::min(window.u_min, point.x() - kMargin);
    window.u_max = std::max(window.u_max, point.x() + kMargin);
    window.v_min = std::min(window.v_min, point.y() - kMargin);
    window.v_max = std::max(window.v_max, point.y() + kMargin);
  }
  return window;
}

/// The longest of 1, 2, 5 times a power of ten that is at most `length`.
double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= length) return factor * power;
  }
  return power;
}

}  // namespace

FilmPlan::FilmPlan(std::vector<RasterPoint> points, std::span<const Eigen::Vector2d> path,
                   int width, int height)
    : points_(std::move(points)), window_(window_around(path)), unit_(height / 400.0) {
  const double edge = 14.0 * unit_;
  const double length = window_.u_max - window_.u_min;
  const double across = window_.v_max - window_.v_min;
  const double scale = std::min((width - 2.0 * edge) / length, 0.20 * height / across);
  area_.width = std::floor(scale * length);
  area_.height = std::floor(scale * across);
  area_.x = std::floor(edge);
  area_.y = std::floor(height - edge - area_.height);
}

Eigen::Vector2d FilmPlan::to_pixels(const Eigen::Vector2d& point) const {
  return {area_.x + (point.x() - window_.u_min) / (window_.u_max - window_.u_min) * area_.width,
          area_.bottom() -
              (point.y() - window_.v_min) / (window_.v_max - window_.v_min) * area_.height};
}

void FilmPlan::draw(Canvas& canvas, std::size_t count, const Eigen::Vector2d& robot,
                    double heading) const {
  const std::span<const RasterPoint> shown(points_.data(), std::min(count, points_.size()));
  const Image map = raster_points({shown.begin(), shown.end()}, window_,
                                  static_cast<int>(area_.width), static_cast<int>(area_.height),
                                  std::max(1, static_cast<int>(std::lround(1.2 * unit_))), kGround);
  canvas.image(map, area_);
  canvas.outline(area_, {{1.0, 1.0, 1.0, 0.25}, unit_});
  const Eigen::Vector2d at = to_pixels(robot);
  const Eigen::Vector2d ahead(std::cos(heading), -std::sin(heading));
  const Eigen::Vector2d aside(-ahead.y(), ahead.x());
  const double size = 6.0 * unit_;
  canvas.fill({at + 1.3 * size * ahead, at - 0.8 * size * ahead + 0.8 * size * aside,
               at - 0.3 * size * ahead, at - 0.8 * size * ahead - 0.8 * size * aside},
              {1.0, 1.0, 1.0});
  const double bar = round_length(0.3 * (window_.u_max - window_.u_min));
  const double pixels = bar / (window_.u_max - window_.u_min) * area_.width;
  const double y = area_.y - 7.0 * unit_;
  const Color light{0.85, 0.87, 0.90};
  const std::string label = fmt::format("{:g} m", bar);
  const TextStyle style{.size = 11.0 * unit_, .color = light, .horizontal = Align::kEnd};
  const double left = area_.right() - pixels - 12.0 * unit_ - canvas.text_width(label, style);
  canvas.fill(Rect{left, y - 7.0 * unit_, area_.right() - left, 13.0 * unit_},
              {0.05, 0.06, 0.08, 0.72});  // the map behind it may be as bright as the letters
  canvas.line({{area_.right() - pixels, y}, {area_.right(), y}}, {light, 1.5 * unit_});
  canvas.text({area_.right() - pixels - 6.0 * unit_, y}, label, style);
}

}  // namespace aims
