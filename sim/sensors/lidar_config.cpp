// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/lidar_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace aims {
namespace {

constexpr std::size_t kMaxLidarLines = 128;  ///< as many as `rings`

}  // namespace

void describe(Fields& f, LidarTableConfig& c) {
  f.numbers("elevations_deg", c.elevations_deg,
            {.unit = "deg",
             .range = in_range(-89.0, 89.0),
             .meaning = "Elevation of each channel, in the order of the datasheet; empty for "
                        "uniform rings. Rings are numbered by elevation, 0 the lowest."});
  f.numbers("azimuth_offsets_deg", c.azimuth_offsets_deg,
            {.unit = "deg",
             .range = within(30.0),
             .meaning = "Azimuth of each channel ahead of the housing, positive clockwise; empty "
                        "for none."});
  f.numbers("firing_delays_us", c.firing_delays_us,
            {.unit = "us",
             .range = up_to(1e4),
             .meaning = "Firing time of each channel after its column begins; empty for "
                        "ring_interval_us."});
}

void describe(Fields& f, LidarRosetteConfig& c) {
  f.number("point_rate", c.point_rate,
           {.unit = "Hz", .range = up_to(1e7), .meaning = "Firings per second of all lines."});
  f.numbers("prism_deflections_deg", c.prism_deflections_deg,
            {.unit = "deg",
             .range = in_range(0.0, 180.0),
             .meaning = "Angle by which each prism deflects the beams."});
  f.numbers("prism_rates", c.prism_rates,
            {.unit = "Hz",
             .range = within(1000.0),
             .meaning = "Turns of each prism per second, positive from +x to +y."});
  f.numbers(
      "line_offsets_deg", c.line_offsets_deg,
      {.unit = "deg",
       .range = within(30.0),
       .meaning = "Offset of each line from the axis of the prisms, in the order of firing."});
  f.number("line_azimuth_deg", c.line_azimuth_deg,
           {.unit = "deg",
            .range = in_range(-360.0, 360.0),
            .meaning = "Azimuth along which the lines are offset."});
}

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

/// Which sensor, how its beams move, and how its clouds are recorded.
void describe_model(Fields& f, LidarConfig& c) {
  std::vector<std::pair<std::string, std::string>> models;
  for (const LidarModel& each : lidar_models()) models.emplace_back(each.name, each.name);
  f.choice(
      "model", c.model, models,
      {.meaning = "Sensor whose figures lie below the other keys.", .source = "models/lidars"});
  f.choice("pattern", c.pattern,
           {{"spinning", LidarPattern::kSpinning}, {"rosette", LidarPattern::kRosette}},
           {.meaning = "How the beams move: rings that spin, or lines behind rotating prisms."});
  f.choice("layout", c.layout, cloud_layout_names(),
           {.meaning = "Layout of the clouds in a recording: that of a vendor's ROS driver."});
}

/// Rings, firings and times of a scan.
void describe_firings(Fields& f, LidarConfig& c) {
  f.integer("rings", c.rings,
            {.unit = "-", .range = in_range(1, 128), .meaning = "Number of rings (lasers)."});
  f.integer(
      "columns", c.columns,
      {.unit = "-", .range = in_range(16, 8192), .meaning = "Firings of each ring per scan."});
  f.number("column_interval_us", c.column_interval_us,
           {.unit = "us",
            .range = up_to(1e5),
            .meaning = "Fixed time between two columns, from scan to scan; 0 for `columns` that "
                       "divide the scan."});
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
  f.number("direction_sigma_deg", c.direction_sigma_deg,
           {.unit = "deg",
            .range = up_to(1.0),
            .meaning = "Standard deviation of the white noise of the reported direction, across "
                       "and up."});
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

/// States what has no effect on a spinning sensor, or on a rosette.
void mark_idle(Fields& f, const LidarConfig& c) {
  const bool rosette = c.pattern == LidarPattern::kRosette;
  f.idle_if(c.table.elevations_deg.empty(), "lidar.table.elevations_deg lists no channels",
            {"table.azimuth_offsets_deg", "table.firing_delays_us"});
  f.idle_if(!c.table.elevations_deg.empty(), "lidar.table.elevations_deg lists the rings",
            {"rings", "elevation_min_deg", "elevation_max_deg"});
  f.idle_if(!c.table.firing_delays_us.empty(), "lidar.table.firing_delays_us lists the delays",
            {"ring_interval_us"});
  f.idle_if(c.column_interval_us > 0.0, "lidar.column_interval_us is fixed", {"columns"});
  f.idle_if(!rosette, "lidar.pattern is spinning", {"rosette"});
  f.idle_if(rosette, "lidar.pattern is rosette: it has lines, no rings and no encoder",
            {"rings", "columns", "column_interval_us", "elevation_min_deg", "elevation_max_deg",
             "start_azimuth_deg", "ring_interval_us", "table", "calibration.ring_range_sigma",
             "calibration.ring_elevation_sigma_deg", "calibration.azimuth_sigma_deg",
             "defects.dead_ring_fraction"});
}

Result<void> validate_table(const LidarTableConfig& table) {
  const auto check = [&](std::string_view name, const std::vector<double>& values) -> Result<void> {
    if (values.empty() || values.size() == table.elevations_deg.size()) return {};
    return failure(fmt::format(
        "lidar.table.{}: expected {} numbers, one per channel of elevations_deg, got {}", name,
        table.elevations_deg.size(), values.size()));
  };
  if (table.elevations_deg.size() > kMaxLidarLines) {
    return failure(fmt::format("lidar.table.elevations_deg: expected at most {} channels, got {}",
                               kMaxLidarLines, table.elevations_deg.size()));
  }
  if (auto ok = check("azimuth_offsets_deg", table.azimuth_offsets_deg); !ok) return ok;
  return check("firing_delays_us", table.firing_delays_us);
}

Result<void> validate_rosette(const LidarConfig& config) {
  const LidarRosetteConfig& rosette = config.rosette;
  if (rosette.prism_deflections_deg.empty() ||
      rosette.prism_deflections_deg.size() != rosette.prism_rates.size()) {
    return failure(
        fmt::format("lidar.rosette.prism_rates: expected one number per prism of "
                    "prism_deflections_deg ({}), at least one, got {}",
                    rosette.prism_deflections_deg.size(), rosette.prism_rates.size()));
  }
  const std::size_t lines = rosette.line_offsets_deg.size();
  if (lines == 0 || lines > kMaxLidarLines) {
    return failure(fmt::format("lidar.rosette.line_offsets_deg: expected 1 to {} lines, got {}",
                               kMaxLidarLines, lines));
  }
  const double columns = rosette.point_rate / (config.rate * static_cast<double>(lines));
  if (columns >= 1.0 && std::abs(columns - std::round(columns)) < 1e-9) return {};
  return failure(
      fmt::format("lidar.rosette.point_rate: expected a whole number of firings of each of the {} "
                  "lines in a scan, got {}",
                  lines, columns));
}

/// Delays that do not fit into a column would fire out of order.
Result<void> validate_columns(const LidarConfig& config) {
  const double interval = config.column_interval_us > 0.0 ? config.column_interval_us
                                                          : 1e6 / (config.rate * config.columns);
  if (config.column_interval_us > 0.0 && 1e6 / config.rate < 16.0 * interval) {
    return failure(
        fmt::format("lidar.column_interval_us: expected at least 16 columns in a scan of {} s, "
                    "got {} us",
                    1.0 / config.rate, interval));
  }
  const auto& delays = config.table.firing_delays_us;
  const auto last = std::ranges::max_element(delays);
  if (last == delays.end() || *last < interval) return {};
  return failure(
      fmt::format("lidar.table.firing_delays_us: expected less than the {} us of a column, got {}",
                  interval, *last));
}

}  // namespace

void describe(Fields& f, LidarConfig& c) {
  describe_model(f, c);
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
  f.group("table", c.table);
  f.group("rosette", c.rosette);
  f.group("beam", c.beam);
  f.group("calibration", c.calibration);
  f.group("defects", c.defects);
  mark_idle(f, c);
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
  if (config.pattern == LidarPattern::kRosette) return validate_rosette(config);
  if (auto ok = validate_table(config.table); !ok) return ok;
  return validate_columns(config);
}

int line_count(const LidarConfig& config) {
  if (config.pattern == LidarPattern::kRosette) {
    return static_cast<int>(config.rosette.line_offsets_deg.size());
  }
  const auto channels = static_cast<int>(config.table.elevations_deg.size());
  return channels > 0 ? channels : config.rings;
}

LidarConfig with_fewer_firings(LidarConfig config, int factor) {
  config.columns = std::max(16, config.columns / factor);
  config.column_interval_us *= factor;
  config.rosette.point_rate /= factor;
  return config;
}

}  // namespace aims
