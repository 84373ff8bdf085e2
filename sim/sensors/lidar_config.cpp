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
  f.number("dead_ring_share", c.dead_ring_share,
           {.unit = "-", .range = in_range(0.0, 1.0), .meaning = "Rings that see nothing."});
  f.number("blind_center_deg", c.blind_center_deg,
           {.unit = "deg",
            .range = in_range(-360.0, 360.0),
            .meaning = "Middle of a covered sector; 0 is ahead."});
  f.number("blind_width_deg", c.blind_width_deg,
           {.unit = "deg", .range = in_range(0.0, 360.0), .meaning = "Of the covered sector."});
}

void describe(Fields& f, LidarConfig& c) {
  f.integer("rings", c.rings, {.unit = "-", .range = in_range(1, 128), .meaning = "Lasers."});
  f.integer("columns", c.columns,
            {.unit = "-", .range = in_range(16, 8192), .meaning = "Firings of a ring per scan."});
  f.number("rate", c.rate,
           {.unit = "Hz", .range = in_range(1.0, 100.0), .meaning = "Scans per second."});
  f.number("elevation_min_deg", c.elevation_min_deg,
           {.unit = "deg", .range = in_range(-89.0, 89.0), .meaning = "Of ring 0."});
  f.number("elevation_max_deg", c.elevation_max_deg,
           {.unit = "deg", .range = in_range(-89.0, 89.0), .meaning = "Of the last ring."});
  f.number("start_azimuth_deg", c.start_azimuth_deg,
           {.unit = "deg", .range = in_range(-360.0, 360.0), .meaning = "Of the first firing."});
  f.number("ring_interval_us", c.ring_interval_us,
           {.unit = "us", .range = at_least(0), .meaning = "Between neighbouring rings."});
  f.number("range_min", c.range_min,
           {.unit = "m", .range = at_least(0), .meaning = "Nearer returns are dropped."});
  f.number("range_max", c.range_max,
           {.unit = "m", .range = in_range(1.0, 500.0), .meaning = "Farther ones are dropped."});
  f.number("range_sigma", c.range_sigma,
           {.unit = "m", .range = in_range(0.0, 1.0), .meaning = "White noise of the range."});
  f.number("miss_probability", c.miss_probability,
           {.unit = "-", .range = in_half_open(0.0, 1.0), .meaning = "Returns lost at random."});
  f.number("range_at_10_percent", c.range_at_10_percent,
           {.unit = "m",
            .range = positive(),
            .meaning = "Where half the returns of a facing target of 10 % are detected."});
  f.number("detection_steepness", c.detection_steepness,
           {.unit = "-",
            .range = in_range(4.0, 50.0),
            .meaning = "Of the detection probability in the received power."});
  f.vector("body_min", c.body_min,
           {.unit = "m", .range = any(), .meaning = "Box of the robot's body, LiDAR frame."});
  f.vector("body_max", c.body_max,
           {.unit = "m", .range = any(), .meaning = "Box of the robot's body, LiDAR frame."});
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
