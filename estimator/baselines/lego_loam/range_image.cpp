// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/range_image.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/angle.hpp"

namespace aims::lego_loam {

namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

AzimuthTimes::AzimuthTimes(double first_azimuth, double last_azimuth)
    : start_(-first_azimuth), end_(-last_azimuth + 2.0 * kPi) {
  if (end_ - start_ > 3.0 * kPi) end_ -= 2.0 * kPi;
  if (end_ - start_ < kPi) end_ += 2.0 * kPi;
}

double AzimuthTimes::next(double azimuth) {
  double orientation = -azimuth;
  if (half_passed_) {
    orientation += 2.0 * kPi;
    if (orientation < end_ - 1.5 * kPi) {
      orientation += 2.0 * kPi;
    } else if (orientation > end_ + 0.5 * kPi) {
      orientation -= 2.0 * kPi;
    }
  } else {
    if (orientation < start_ - 0.5 * kPi) {
      orientation += 2.0 * kPi;
    } else if (orientation > start_ + 1.5 * kPi) {
      orientation -= 2.0 * kPi;
    }
    half_passed_ = orientation - start_ > kPi;
  }
  return (orientation - start_) / (end_ - start_);
}

namespace {

/// Column of an azimuth [rad].
int column_of(double azimuth, int columns) {
  const double turns = azimuth / (2.0 * std::numbers::pi);
  const auto column = static_cast<int>(std::lround(turns * columns)) + columns / 2;
  return (column % columns + columns) % columns;
}

}  // namespace

void describe(Fields& f, RangeImageConfig& c) {
  f.number("min_range", c.min_range, {"m", up_to(1e4), "nearer returns are ignored"});
  f.number("max_range", c.max_range, {"m", positive_up_to(1e4), "farther returns are ignored"});
  f.integer("rows", c.rows,
            {"-", in_range(2, features::kMaxRings), "rings of the LiDAR; higher ones are ignored"});
  f.integer("columns", c.columns, {"-", in_range(10, 100000), "cells of one turn"});
  f.number("row_angle_deg", c.row_angle_deg,
           {"deg", in_range(0.01, 45.0), "angle between two rings"});
  f.integer(
      "ground_rows", c.ground_rows,
      {"-", in_range(0, features::kMaxRings), "pairs of the lowest rings that see the ground"});
  f.number("ground_slope_deg", c.ground_slope_deg,
           {"deg", in_range(0.0, 90.0), "steepest ground between two rings", "LeGO-LOAM, III-B"});
  f.number("segment_angle_deg", c.segment_angle_deg,
           {"deg", in_range(0.0, 90.0), "neighbours seen at a larger angle are one object"});
  f.integer("large_segment", c.large_segment,
            {"-", in_range(1, 1000000), "returns of a segment that is always kept"});
  f.integer("small_segment", c.small_segment,
            {"-", in_range(1, 1000000), "returns of a segment that is kept if it spans rings"});
  f.integer("small_segment_rows", c.small_segment_rows,
            {"-", in_range(0, features::kMaxRings), "rings that a small segment spans"});
  f.integer("stride", c.stride,
            {"-", in_range(1, 1000), "one column in this many keeps ground and outliers"});
}

RangeImage::Angle::Angle(double degrees)
    : sine(std::sin(kRadiansPerDegree * degrees)), cosine(std::cos(kRadiansPerDegree * degrees)) {}

bool RangeImage::Angle::less_than(double opposite, double adjacent) const {
  return opposite * cosine > adjacent * sine;
}

RangeImage::RangeImage(const LidarScan& scan, const RangeImageConfig& config)
    : config_(config),
      column_angle_(360.0 / config.columns),
      row_angle_(config.row_angle_deg),
      segment_angle_(config.segment_angle_deg),
      ground_slope_(config.ground_slope_deg) {
  project(scan);
  label_ground();
  label_segments();
}

double azimuth_of(const Eigen::Vector3f& position) {
  return std::atan2(static_cast<double>(position.y()), static_cast<double>(position.x()));
}

void RangeImage::project(const LidarScan& scan) {
  const auto finite = [](const LidarPoint& each) { return each.position.allFinite(); };
  const auto first = std::find_if(scan.points.begin(), scan.points.end(), finite);
  const auto last = std::find_if(scan.points.rbegin(), scan.points.rend(), finite);
  if (first != scan.points.end()) {
    first_azimuth_ = azimuth_of(first->position);
    last_azimuth_ = azimuth_of(last->position);
  }
  const auto cells =
      static_cast<std::size_t>(config_.rows) * static_cast<std::size_t>(config_.columns);
  points_.resize(cells);
  ranges_.assign(cells, 0.0F);
  kinds_.assign(cells, CellKind::kEmpty);
  const auto rings = features::ring_clouds(scan, config_.min_range, config_.max_range);
  const int rows = std::min(config_.rows, static_cast<int>(rings.size()));
  for (int row = 0; row < rows; ++row) {
    for (const features::FeaturePoint& point : rings[static_cast<std::size_t>(row)]) {
      const std::size_t at = cell(row, column_of(azimuth_of(point.position), config_.columns));
      points_[at] = point;
      ranges_[at] = point.position.norm();
      kinds_[at] = CellKind::kUnlabelled;
      ++count_;
    }
  }
}

/// Whether the line from a return to that of the next ring is as level as ground.
bool RangeImage::level(int row, int column) const {
  const Eigen::Vector3f step = point(row + 1, column).position - point(row, column).position;
  return !ground_slope_.less_than(std::abs(step.z()), step.head<2>().norm());
}

/// A return whose upper neighbour is missing is no ground, whatever the pair below it.
void RangeImage::label_ground() {
  const int pairs = std::min(config_.ground_rows, config_.rows - 1);
  std::vector<CellKind> ground = kinds_;
  for (int column = 0; column < config_.columns; ++column) {
    for (int row = 0; row < pairs; ++row) {
      const std::size_t lower = cell(row, column);
      const std::size_t upper = cell(row + 1, column);
      if (kinds_[lower] == CellKind::kEmpty || kinds_[upper] == CellKind::kEmpty) {
        ground[lower] = kinds_[lower];
      } else if (level(row, column)) {
        ground[lower] = CellKind::kGround;
        ground[upper] = CellKind::kGround;
      }
    }
  }
  kinds_ = std::move(ground);
}

void RangeImage::label_segments() {
  for (int row = 0; row < config_.rows; ++row) {
    for (int column = 0; column < config_.columns; ++column) {
      if (kind(row, column) == CellKind::kUnlabelled) grow_segment(row, column);
    }
  }
}

/// Breadth-first search from a cell over neighbours of the same object.
void RangeImage::grow_segment(int row, int column) {
  std::vector<std::size_t> segment = {cell(row, column)};
  kinds_[segment.front()] = CellKind::kSegment;
  for (std::size_t next = 0; next < segment.size(); ++next) {
    visit_neighbors(segment[next], segment);
  }
  if (is_segment(segment)) return;
  for (const std::size_t each : segment) kinds_[each] = CellKind::kOutlier;
}

void RangeImage::visit_neighbors(std::size_t from, std::vector<std::size_t>& segment) {
  const auto columns = static_cast<std::size_t>(config_.columns);
  const int row = static_cast<int>(from / columns);
  const int column = static_cast<int>(from % columns);
  const auto visit = [&](int to_row, int to_column, const Angle& between) {
    if (to_row < 0 || to_row >= config_.rows) return;
    const std::size_t to = cell(to_row, (to_column + config_.columns) % config_.columns);
    if (kinds_[to] != CellKind::kUnlabelled || !same_object(from, to, between)) return;
    kinds_[to] = CellKind::kSegment;
    segment.push_back(to);
  };
  visit(row - 1, column, row_angle_);
  visit(row, column + 1, column_angle_);
  visit(row, column - 1, column_angle_);
  visit(row + 1, column, row_angle_);
}

/// Whether the line between two returns, whose beams are `between` apart, meets the beam of the
/// farther one at more than the angle of the configuration.
bool RangeImage::same_object(std::size_t a, std::size_t b, const Angle& between) const {
  const double far = std::max(ranges_[a], ranges_[b]);
  const double near = std::min(ranges_[a], ranges_[b]);
  return segment_angle_.less_than(near * between.sine, far - near * between.cosine);
}

/// The ring of the first cell counts where others of the segment lie in it.
bool RangeImage::is_segment(const std::vector<std::size_t>& cells) const {
  const int count = static_cast<int>(cells.size());
  if (count >= config_.large_segment) return true;
  if (count < config_.small_segment) return false;
  std::set<std::size_t> rows;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    rows.insert(cells[i] / static_cast<std::size_t>(config_.columns));
  }
  return static_cast<int>(rows.size()) >= config_.small_segment_rows;
}

}  // namespace aims::lego_loam
