// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>

#include "sim/sensors/lidar.hpp"

namespace aims {
namespace {

constexpr double kReferenceReflectivity = 0.1;
/// Received power over the threshold beyond which a return is certain, and below the inverse of
/// which there is none.
constexpr double kCertainPower = 8.0;

}  // namespace

void describe(Fields& f, LidarDefectConfig& c) {
  f.number("dead_ring_fraction", c.dead_ring_fraction,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning = "Fraction of the rings that return nothing."});
  f.number("blocked_sector_center_deg", c.blocked_sector_center_deg,
           {.unit = "deg",
            .range = in_range(-360.0, 360.0),
            .meaning = "Azimuth of the middle of the blocked sector; 0 is ahead."});
  f.number("blocked_sector_width_deg", c.blocked_sector_width_deg,
           {.unit = "deg",
            .range = in_range(0.0, 360.0),
            .meaning = "Width of the blocked sector; 0 for none."});
}

void describe(Fields& f, LidarConfig& c) {
  f.integer("rings", c.rings,
            {.unit = "-", .range = in_range(1, 128), .meaning = "Number of rings (lasers)."});
  f.integer(
      "columns", c.columns,
      {.unit = "-", .range = in_range(16, 8192), .meaning = "Firings of each ring per scan."});
  f.number("rate", c.rate,
           {.unit = "Hz", .range = in_range(1.0, 100.0), .meaning = "Scans per second."});
  f.number("elevation_min_deg", c.elevation_min_deg,
           {.unit = "deg", .range = in_range(-89.0, 89.0), .meaning = "Elevation of ring 0."});
  f.number(
      "elevation_max_deg", c.elevation_max_deg,
      {.unit = "deg", .range = in_range(-89.0, 89.0), .meaning = "Elevation of the last ring."});
  f.number(
      "start_azimuth_deg", c.start_azimuth_deg,
      {.unit = "deg", .range = in_range(-360.0, 360.0), .meaning = "Azimuth of the first firing."});
  f.number("ring_interval_us", c.ring_interval_us,
           {.unit = "us",
            .range = up_to(1e4),
            .meaning = "Time between the firings of neighbouring rings."});
  f.number("range_min", c.range_min,
           {.unit = "m",
            .range = up_to(1e4),
            .meaning = "Smallest measured range; nearer returns are dropped."});
  f.number("range_max", c.range_max,
           {.unit = "m",
            .range = in_range(1.0, 500.0),
            .meaning = "Largest measured range; farther returns are dropped."});
  f.number("range_sigma", c.range_sigma,
           {.unit = "m",
            .range = in_range(0.0, 1.0),
            .meaning = "Standard deviation of the white range noise."});
  f.number("miss_probability", c.miss_probability,
           {.unit = "-",
            .range = in_half_open(0.0, 1.0),
            .meaning = "Probability that a return is lost at random."});
  f.number("range_at_10_percent", c.range_at_10_percent,
           {.unit = "m",
            .range = positive_up_to(1e4),
            .meaning = "Range at which half the returns of a perpendicular target of 10 % "
                       "reflectivity are detected."});
  f.number("detection_steepness", c.detection_steepness,
           {.unit = "-",
            .range = in_range(4.0, 50.0),
            .meaning = "Steepness of the detection probability over the received power."});
  f.vector("body_mask_min", c.body_mask_min,
           {.unit = "m",
            .range = within(100.0),
            .meaning = "Lower corner of the body mask in the LiDAR frame."});
  f.vector("body_mask_max", c.body_mask_max,
           {.unit = "m",
            .range = within(100.0),
            .meaning = "Upper corner of the body mask in the LiDAR frame."});
  f.group("defects", c.defects);
}

Result<void> validate(const LidarConfig& config) {
  if (config.range_max <= config.range_min) {
    return failure(fmt::format("lidar.range_max: expected more than {} m (range_min), got {}",
                               config.range_min, config.range_max));
  }
  if (config.elevation_max_deg < config.elevation_min_deg) {
    return failure(
        fmt::format("lidar.elevation_max_deg: expected at least {} deg (elevation_min_deg), got {}",
                    config.elevation_min_deg, config.elevation_max_deg));
  }
  return {};
}

double detection_probability(const LidarConfig& config, double reflectivity, double cos_incidence,
                             double range) {
  const double ratio = config.range_at_10_percent / range;
  const double power = reflectivity / kReferenceReflectivity * cos_incidence * ratio * ratio;
  if (power >= kCertainPower) return 1.0;
  if (power * kCertainPower <= 1.0) return 0.0;
  return 1.0 / (1.0 + std::pow(power, -config.detection_steepness));
}

}  // namespace aims
