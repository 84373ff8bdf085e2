// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/lidar_config.hpp"

#include <fmt/format.h>

namespace aims {
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

void describe(Fields& f, LidarCalibrationConfig& c) {
  const auto length = [&](std::string_view name, double& value, std::string meaning,
                          std::string source = {}) {
    f.number(name, value,
             {.unit = "m",
              .range = up_to(0.5),
              .meaning = std::move(meaning),
              .source = std::move(source)});
  };
  const auto angle = [&](std::string_view name, double& value, std::string meaning) {
    f.number(name, value, {.unit = "deg", .range = up_to(2.0), .meaning = std::move(meaning)});
  };
  length("range_bias_sigma", c.range_bias_sigma,
         "Standard deviation of the offset of all ranges, drawn per run.");
  length("incidence_bias_mean", c.incidence_bias_mean,
         "Mean of the factor c of the range offset c (1 / cos(incidence) - 1).",
         "Laconte et al., ICRA 2019");
  length("incidence_bias_sigma", c.incidence_bias_sigma,
         "Standard deviation of that factor, drawn per run.");
  length("ring_range_sigma", c.ring_range_sigma,
         "Standard deviation of each ring's range offset, drawn per run.");
  angle("ring_elevation_sigma_deg", c.ring_elevation_sigma_deg,
        "Standard deviation of each ring's true elevation about the nominal one, drawn per run.");
  angle("azimuth_sigma_deg", c.azimuth_sigma_deg,
        "Standard deviation of both components of the encoder error of one period per revolution, "
        "drawn per run.");
}

void describe(Fields& f, LidarBeamConfig& c) {
  f.number("divergence_horizontal", c.divergence_horizontal,
           {.unit = "rad",
            .range = up_to(0.1),
            .meaning = "Full horizontal angle by which the beam widens."});
  f.number("divergence_vertical", c.divergence_vertical,
           {.unit = "rad",
            .range = up_to(0.1),
            .meaning = "Full vertical angle by which the beam widens."});
  f.number("exit_width", c.exit_width,
           {.unit = "m", .range = up_to(0.1), .meaning = "Width of the beam at the sensor."});
  f.number("exit_height", c.exit_height,
           {.unit = "m", .range = up_to(0.1), .meaning = "Height of the beam at the sensor."});
  f.number("pulse_length", c.pulse_length,
           {.unit = "m",
            .range = in_range(0.05, 10.0),
            .meaning = "Surfaces in one footprint that are nearer to each other in range give one "
                       "return between them; others two echoes, of which the stronger is reported.",
            .source = "VLP-16 user manual: two returns of a firing are at least 1 m apart"});
}

namespace {

/// Rings, firings and times of a scan.
void describe_firings(Fields& f, LidarConfig& c) {
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
}

/// What a range is measured with.
void describe_ranges(Fields& f, LidarConfig& c) {
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
  f.number("range_sigma_at_threshold", c.range_sigma_at_threshold,
           {.unit = "m",
            .range = up_to(1.0),
            .meaning = "Further white range noise at the power of the detection threshold; its "
                       "variance falls as one over the received power."});
  f.number(
      "range_resolution", c.range_resolution,
      {.unit = "m", .range = up_to(1.0), .meaning = "Step of the reported range; 0 for none."});
}

/// Which returns arrive, and how strong.
void describe_returns(Fields& f, LidarConfig& c) {
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
  f.number("specular_loss", c.specular_loss,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning = "Smoothness of the surfaces: the part of the Fresnel reflection that is "
                       "mirrored away and lost, once out and once back.",
            .source = "Schlick's approximation with 4 % at normal incidence"});
  f.number("intensity_sigma", c.intensity_sigma,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning = "Standard deviation of the intensity relative to its value."});
  f.number("intensity_resolution", c.intensity_resolution,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning = "Step of the reported intensity; 0 for none."});
}

}  // namespace

void describe(Fields& f, LidarConfig& c) {
  describe_firings(f, c);
  describe_ranges(f, c);
  describe_returns(f, c);
  f.vector("body_mask_min", c.body_mask_min,
           {.unit = "m",
            .range = within(100.0),
            .meaning = "Lower corner of the body mask in the LiDAR frame."});
  f.vector("body_mask_max", c.body_mask_max,
           {.unit = "m",
            .range = within(100.0),
            .meaning = "Upper corner of the body mask in the LiDAR frame."});
  f.group("beam", c.beam);
  f.group("calibration", c.calibration);
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

}  // namespace aims
