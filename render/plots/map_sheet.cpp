// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/map_sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "render/plots/palette.hpp"
#include "render/plots/scene_plan.hpp"

namespace aims {
namespace {

constexpr double kMaxHeight = 1100.0;         ///< of a picture [px]
constexpr std::size_t kMostSquares = 40'000;  ///< beyond it a vector picture is slow to open

/// Value below which that fraction of `values` lies; reorders them.
double percentile(std::vector<float>& values, double fraction) {
  const auto index = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

/// At most about 200,000 of the values, evenly picked: enough for percentiles.
template <class ValueOf>
std::vector<float> sample(std::size_t size, ValueOf value_of) {
  const std::size_t stride = std::max<std::size_t>(1, size / 200'000);
  std::vector<float> values;
  for (std::size_t i = 0; i < size; i += stride) values.push_back(value_of(i));
  return values;
}

std::vector<Eigen::Vector3f> finite_points(const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> finite;
  finite.reserve(points.size());
  std::copy_if(points.begin(), points.end(), std::back_inserter(finite),
               [](const Eigen::Vector3f& p) { return p.allFinite() && p.norm() < 1e5F; });
  return finite;
}

/// Drops what is higher than `section` over the floor around it.
void open_roof(std::vector<Eigen::Vector3f>& points, double section) {
  const std::vector<bool> under = under_roof(points, section);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (under[i]) points[kept++] = points[i];
  }
  points.resize(kept);
}

/// What the view makes of a position: right and up in the picture, and towards the viewer.
Eigen::Vector3d seen(MapView view, const Eigen::Vector3d& p) {
  return view == MapView::kAbove ? Eigen::Vector3d(p.x(), p.y(), p.z())
                                 : Eigen::Vector3d(p.x(), p.z(), -p.y());
}

std::vector<RasterPoint> raster_of(MapView view, const std::vector<Eigen::Vector3f>& points,
                                   const HeightRange& heights) {
  std::vector<RasterPoint> result;
  result.reserve(points.size());
  const double scale = 1.0 / std::max(1e-6, heights.max - heights.min);
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f uvn = seen(view, point.cast<double>()).cast<float>();
    const auto height = static_cast<float>((point.z() - heights.min) * scale);
    result.push_back({uvn.x(), uvn.y(), uvn.z(), height});
  }
  return result;
}

std::vector<Eigen::Vector2d> track_of(MapView view, const Trajectory& trajectory) {
  std::vector<Eigen::Vector2d> track;
  for (const StampedPose& sample : trajectory)
    track.emplace_back(seen(view, sample.pose.translation).head<2>());
  return track;
}

/// The part of the plane that holds the points, but for outliers, and the track.
RasterWindow window_of(const std::vector<RasterPoint>& points,
                       const std::vector<Eigen::Vector2d>& track) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  RasterWindow window{kInfinity, -kInfinity, kInfinity, -kInfinity};
  const auto include = [&](double u, double v) {
    if (!std::isfinite(u) || !std::isfinite(v)) return;
    window.u_min = std::min(window.u_min, u);
    window.u_max = std::max(window.u_max, u);
    window.v_min = std::min(window.v_min, v);
    window.v_max = std::max(window.v_max, v);
  };
  for (const Eigen::Vector2d& point : track) include(point.x(), point.y());
  if (!points.empty()) {
    auto us = sample(points.size(), [&](std::size_t i) { return points[i].u; });
    auto vs = sample(points.size(), [&](std::size_t i) { return points[i].v; });
    include(percentile(us, 0.002), percentile(vs, 0.002));
    include(percentile(us, 0.998), percentile(vs, 0.998));
  }
  if (!(window.u_max >= window.u_min)) include(0.0, 0.0);
  const double grow_u = std::max(0.5, 0.5 * (4.0 - (window.u_max - window.u_min)));
  const double grow_v = std::max(0.4, 0.5 * (2.0 - (window.v_max - window.v_min)));
  return {window.u_min - grow_u, window.u_max + grow_u, window.v_min - grow_v,
          window.v_max + grow_v};
}

MapLayout layout_of(RasterWindow& window, double width) {
  const double length = window.u_max - window.u_min;
  const double across = window.v_max - window.v_min;
  MapLayout best;
  for (int strips = 1; strips <= 4; ++strips) {
    const double scale = width * strips / length;
    const MapLayout layout{strips, scale, width, std::round(scale * across)};
    if (strips == 1 || layout.total() <= kMaxHeight) best = layout;
  }
  if (best.total() > kMaxHeight) {  // as high as wide: the height decides
    best.height = kMaxHeight - best.top - MapLayout::kBetween;
    best.scale = best.height / across;
    const double grow = 0.5 * (width / best.scale - length);
    window.u_min -= grow;
    window.u_max += grow;
  }
  return best;
}

/// Pixels per point so that neighbouring points touch where the map is as dense as in the median
/// cell of a coarse grid.
int point_size(const std::vector<RasterPoint>& points, double scale) {
  constexpr float kCell = 0.25F;
  auto cells = sample(points.size(), [&](std::size_t i) {
    return std::floor(points[i].u / kCell) * 4099.0F + std::floor(points[i].v / kCell);
  });
  if (cells.empty()) return 2;
  std::sort(cells.begin(), cells.end());
  std::vector<float> counts;
  for (auto cell = cells.begin(); cell != cells.end();) {
    const auto next = std::upper_bound(cell, cells.end(), *cell);
    counts.push_back(static_cast<float>(next - cell));
    cell = next;
  }
  const double thinning = static_cast<double>(points.size()) / static_cast<double>(cells.size());
  const double spacing = kCell / std::sqrt(thinning * percentile(counts, 0.5));
  return std::clamp(static_cast<int>(std::lround(2.0 * spacing * scale)), 2, 6);
}

/// How a vector picture shows its points: as the smallest squares that are not too many.
void choose_squares(MapSheet& sheet) {
  const auto count = [&sheet] {
    std::size_t sum = 0;
    for (int strip = 0; strip < sheet.layout.strips; ++strip) {
      sum += visible_points(sheet, strip).size();
    }
    return sum;
  };
  while (count() > kMostSquares) ++sheet.point_size;
  sheet.squares = true;
}

constexpr std::array<std::uint8_t, 3> kDark = {18, 20, 26};
constexpr std::size_t kTints = 32;  ///< of squares, each colour one shape

void draw_squares(Canvas& canvas, const MapSheet& sheet, int strip, const Panel& panel,
                  const Rect& area) {
  std::array<std::vector<Eigen::Vector2d>, kTints> centers;
  for (const RasterPoint& point : visible_points(sheet, strip)) {
    const float fraction = std::clamp(point.height, 0.0F, 1.0F);
    const auto tint = std::min(kTints - 1, static_cast<std::size_t>(fraction * kTints));
    centers[tint].push_back(to_pixels(panel, area, {point.u, point.v}));
  }
  canvas.fill(area, {kDark[0] / 255.0, kDark[1] / 255.0, kDark[2] / 255.0});
  for (std::size_t tint = 0; tint < kTints; ++tint) {
    if (centers[tint].empty()) continue;
    const double fraction = (static_cast<double>(tint) + 0.5) / kTints;
    canvas.squares(centers[tint], sheet.point_size, height_color(fraction));
  }
}

void draw_pixels(Canvas& canvas, const MapSheet& sheet, int strip, const Rect& area) {
  canvas.image(raster_points(sheet.points, window_of(sheet, strip), static_cast<int>(area.width),
                             static_cast<int>(area.height), sheet.point_size, kDark),
               area);
}

/// The sheet without window and layout.
MapSheet unplaced_sheet(MapView view, const MapPicture& map) {
  std::vector<Eigen::Vector3f> points = finite_points(map.points);
  MapSheet sheet;
  sheet.view = view;
  sheet.finite = points.size();
  sheet.heights = map.heights.value_or(map_heights(points));
  if (view == MapView::kAbove) open_roof(points, map.section);
  sheet.points = raster_of(view, points, sheet.heights);
  sheet.track = track_of(view, map.trajectory);
  return sheet;
}

}  // namespace

RasterWindow window_of(const MapSheet& sheet, int strip) {
  const double length = sheet.layout.width / sheet.layout.scale;
  RasterWindow part = sheet.window;
  part.u_min += strip * length;
  part.u_max = part.u_min + length;
  return part;
}

std::vector<RasterPoint> visible_points(const MapSheet& sheet, int strip) {
  const RasterWindow part = window_of(sheet, strip);
  const double per_metre = sheet.layout.scale / sheet.point_size;
  const auto columns = static_cast<std::size_t>(sheet.layout.width / sheet.point_size) + 1;
  const auto rows = static_cast<std::size_t>(sheet.layout.height / sheet.point_size) + 1;
  std::vector<const RasterPoint*> nearest(columns * rows, nullptr);
  for (const RasterPoint& point : sheet.points) {
    if (point.u < part.u_min || point.u > part.u_max || point.v < part.v_min ||
        point.v > part.v_max) {
      continue;
    }
    const auto column = static_cast<std::size_t>((point.u - part.u_min) * per_metre);
    const auto row = static_cast<std::size_t>((point.v - part.v_min) * per_metre);
    const RasterPoint*& kept =
        nearest[std::min(row, rows - 1) * columns + std::min(column, columns - 1)];
    if (kept == nullptr || kept->nearness < point.nearness) kept = &point;
  }
  std::vector<RasterPoint> visible;
  for (const RasterPoint* point : nearest) {
    if (point != nullptr) visible.push_back(*point);
  }
  return visible;
}

HeightRange map_heights(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> heights = sample(points.size(), [&](std::size_t i) { return points[i].z(); });
  std::erase_if(heights, [](float z) { return !std::isfinite(z); });
  if (heights.empty()) return {};
  HeightRange range{percentile(heights, 0.01), percentile(heights, 0.99)};
  const double lacking = 0.5 - (range.max - range.min);
  if (lacking > 0.0) range = {range.min - lacking / 2.0, range.max + lacking / 2.0};
  return range;
}

MapSheet map_sheet(MapView view, const MapPicture& map, double width, bool squares) {
  MapSheet sheet = unplaced_sheet(view, map);
  sheet.window = window_of(sheet.points, sheet.track);
  sheet.layout = layout_of(sheet.window, width);
  sheet.point_size = point_size(sheet.points, sheet.layout.scale);
  if (squares) choose_squares(sheet);
  return sheet;
}

MapSheet map_sheet_of(MapView view, const MapPicture& map, const RasterWindow& window,
                      double width) {
  MapSheet sheet = unplaced_sheet(view, map);
  sheet.window = window;
  const double scale = width / (window.u_max - window.u_min);
  sheet.layout = {1, scale, width, std::round(scale * (window.v_max - window.v_min))};
  sheet.point_size = point_size(sheet.points, scale);
  return sheet;
}

void draw_strip(Canvas& canvas, const MapSheet& sheet, int strip, const Panel& panel,
                const Rect& area) {
  std::vector<Eigen::Vector2d> line;
  for (const Eigen::Vector2d& point : sheet.track) line.push_back(to_pixels(panel, area, point));
  canvas.clip(area);
  if (sheet.squares) {
    draw_squares(canvas, sheet, strip, panel, area);
  } else {
    draw_pixels(canvas, sheet, strip, area);
  }
  canvas.line(line, {{0.0, 0.0, 0.0, 0.6}, 2.6});
  canvas.line(line, {{1.0, 1.0, 1.0}, 1.1});
  if (!line.empty()) canvas.disc(line.front(), 4.0, {1.0, 1.0, 1.0});
  canvas.unclip();
}

}  // namespace aims
