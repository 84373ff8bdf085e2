// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/scan_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/angle.hpp"

namespace aims {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// The channels of the table by rank of their elevations, the lowest first.
std::vector<std::size_t> by_elevation(const std::vector<double>& elevations_deg) {
  std::vector<std::size_t> channels(elevations_deg.size());
  std::iota(channels.begin(), channels.end(), 0);
  std::ranges::stable_sort(channels, {}, [&](std::size_t each) { return elevations_deg[each]; });
  return channels;
}

SpinningPattern spinning(const LidarConfig& config) {
  SpinningPattern pattern;
  pattern.start_azimuth = config.start_azimuth_deg * kRadiansPerDegree;
  pattern.period_ns = static_cast<double>(scan_period(config));
  const LidarTableConfig& table = config.table;
  for (const std::size_t channel : by_elevation(table.elevations_deg)) {
    const double ahead =
        table.azimuth_offsets_deg.empty() ? 0.0 : table.azimuth_offsets_deg[channel];
    pattern.rings.push_back(
        {table.elevations_deg[channel] * kRadiansPerDegree, -ahead * kRadiansPerDegree});
  }
  if (!pattern.rings.empty()) return pattern;
  for (int ring = 0; ring < config.rings; ++ring) {
    const double fraction = config.rings > 1 ? static_cast<double>(ring) / (config.rings - 1) : 0.0;
    pattern.rings.push_back({kRadiansPerDegree * std::lerp(config.elevation_min_deg,
                                                           config.elevation_max_deg, fraction),
                             0.0});
  }
  return pattern;
}

RosettePattern rosette(const LidarRosetteConfig& config) {
  RosettePattern pattern;
  for (std::size_t i = 0; i < config.prism_deflections_deg.size(); ++i) {
    pattern.prisms.push_back(
        {config.prism_deflections_deg[i] * kRadiansPerDegree, kTurn * config.prism_rates[i]});
  }
  const double along = config.line_azimuth_deg * kRadiansPerDegree;
  for (const double offset_deg : config.line_offsets_deg) {
    const double offset = offset_deg * kRadiansPerDegree;
    pattern.line_offsets.emplace_back(offset * std::cos(along), offset * std::sin(along));
  }
  return pattern;
}

/// Delays of the rings of a spinning sensor after their column begins [ns].
std::vector<double> ring_delays(const LidarConfig& config, double column_ns) {
  std::vector<double> delays;
  const std::vector<double>& listed = config.table.firing_delays_us;
  if (!listed.empty()) {
    for (const std::size_t channel : by_elevation(config.table.elevations_deg)) {
      delays.push_back(1e3 * listed[channel]);
    }
    return delays;
  }
  const int rings = line_count(config);
  const double interval = std::min(1e3 * config.ring_interval_us, column_ns / rings);
  for (int ring = 0; ring < rings; ++ring) delays.push_back(ring * interval);
  return delays;
}

/// The rings in the order of the datasheet's channels, or ascending.
std::vector<int> listed_order(const LidarConfig& config, std::size_t lines) {
  std::vector<int> order(lines);
  std::iota(order.begin(), order.end(), 0);
  if (config.pattern == LidarPattern::kRosette || config.table.elevations_deg.empty()) return order;
  const auto channels = by_elevation(config.table.elevations_deg);
  for (std::size_t ring = 0; ring < lines; ++ring) order[channels[ring]] = static_cast<int>(ring);
  return order;
}

}  // namespace

Duration scan_period(const LidarConfig& config) { return from_seconds(1.0 / config.rate); }

Eigen::Vector3d BeamAngles::direction() const {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

BeamAngles SpinningPattern::beam(int ring, double time_offset_ns) const {
  const double turned = time_offset_ns / period_ns;
  const Ring& each = rings[static_cast<std::size_t>(ring)];
  return {start_azimuth - kTurn * turned + each.azimuth_offset, each.elevation};
}

BeamAngles RosettePattern::beam(int line, double time_s) const {
  Eigen::Vector2d sum = line_offsets[static_cast<std::size_t>(line)];
  for (const Prism& prism : prisms) {
    const double angle = prism.rate * time_s;
    sum += prism.deflection * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  return {std::atan2(sum.y(), sum.x()), 0.5 * std::numbers::pi - sum.norm()};
}

ScanPattern::ScanPattern(const LidarConfig& config) : period_(scan_period(config)) {
  const auto period_ns = static_cast<double>(period_);
  if (config.pattern == LidarPattern::kRosette) {
    pattern_ = rosette(config.rosette);
    const int lines = line_count(config);
    column_ns_ = 1e9 * lines / config.rosette.point_rate;
    columns_ = std::max(1, static_cast<int>(std::lround(period_ns / column_ns_)));
    for (int line = 0; line < lines; ++line) delays_ns_.push_back(line * column_ns_ / lines);
  } else {
    pattern_ = spinning(config);
    const bool fixed = config.column_interval_us > 0.0;
    column_ns_ = fixed ? 1e3 * config.column_interval_us : period_ns / config.columns;
    columns_ = fixed ? 0 : config.columns;
    delays_ns_ = ring_delays(config, column_ns_);
  }
  order_ = listed_order(config, delays_ns_.size());
  std::ranges::stable_sort(order_, {}, [&](int line) { return delay_ns(line); });
}

bool ScanPattern::repeats() const { return has_rings() && columns_ > 0; }

int ScanPattern::max_columns() const {
  return columns_ > 0 ? columns_
                      : static_cast<int>(std::ceil(static_cast<double>(period_) / column_ns_));
}

double ScanPattern::first_column_ns(std::int64_t scan) const {
  if (columns_ > 0) return 0.0;
  const double start = static_cast<double>(scan) * static_cast<double>(period_);
  return std::ceil(start / column_ns_) * column_ns_ - start;
}

int ScanPattern::columns(std::int64_t scan) const {
  if (columns_ > 0) return columns_;
  const double last_delay = *std::ranges::max_element(delays_ns_);
  const double left = static_cast<double>(period_) - first_column_ns(scan) - last_delay;
  return static_cast<int>(std::ceil(left / column_ns_));
}

double ScanPattern::column_angle() const {
  if (const auto* rosette = std::get_if<RosettePattern>(&pattern_)) {
    double fastest = 0.0;
    for (const auto& prism : rosette->prisms) fastest = std::max(fastest, std::abs(prism.rate));
    return 1e-9 * fastest * column_ns_;
  }
  return columns_ > 0 ? kTurn / columns_ : kTurn * column_ns_ / static_cast<double>(period_);
}

Firing ScanPattern::firing(std::int64_t scan, int column, int line) const {
  const double offset = column * column_ns_ + delay_ns(line) + first_column_ns(scan);
  if (const auto* spinning = std::get_if<SpinningPattern>(&pattern_)) {
    return {spinning->beam(line, offset), offset, line};
  }
  const double start_s = 1e-9 * static_cast<double>(period_) * static_cast<double>(scan);
  return {std::get<RosettePattern>(pattern_).beam(line, start_s + 1e-9 * offset), offset, line};
}

CloudFormat cloud_format(const LidarConfig& config) {
  const ScanPattern pattern(config);
  return {config.layout, pattern.lines(), pattern.max_columns(), pattern.column_period_ns()};
}

std::vector<Firing> ScanPattern::firings(std::int64_t scan) const {
  std::vector<Firing> all;
  const int count = columns(scan);
  all.reserve(static_cast<std::size_t>(count) * order_.size());
  for (int column = 0; column < count; ++column) {
    for (const int line : order_) all.push_back(firing(scan, column, line));
  }
  return all;
}

}  // namespace aims
