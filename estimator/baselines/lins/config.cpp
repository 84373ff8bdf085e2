// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/config.hpp"

namespace aims::lins {

lego_loam::MappingConfig mapping_config() {
  lego_loam::MappingConfig config;
  config.every_nth = 1;
  config.loop.enabled = true;
  config.loop.radius = 5.0;
  return config;
}

void describe(Fields& f, MinFeatures& c) {
  const auto count = [](const char* meaning) { return Spec{"-", in_range(0, 1000000), meaning}; };
  f.integer("start_edges", c.start_edges, count("less sharp features of each of two first scans"));
  f.integer("start_planes", c.start_planes, count("less flat features of each of two first scans"));
  f.integer("edges", c.edges, count("less sharp features of each later scan"));
  f.integer("planes", c.planes, count("less flat features of each later scan"));
}

void describe(Fields& f, FilterConfig& c) {
  f.choice("predict_until", c.predict_until,
           {{"scan_stamp", PredictionEnd::kScanStamp}, {"scan_end", PredictionEnd::kScanEnd}},
           {"", any(), "until when the IMU predicts the motion of a scan"});
  f.number("horizontal_force_bias", c.horizontal_force_bias,
           {"m/s^2", up_to(1e3), "deviation of the accelerometer's biases x and y at the start"});
  f.number("vertical_force_bias", c.vertical_force_bias,
           {"m/s^2", up_to(1e3), "deviation of the accelerometer's bias z at the start"});
  f.number("gyro_bias", c.gyro_bias,
           {"rad/s", up_to(1e3), "deviation of the gyroscope's biases at the start"});
  f.number("gravity", c.gravity, {"m/s^2", up_to(1e3), "deviation of gravity at the start"});
  f.flag("turn_gravity", c.turn_gravity,
         {"", any(), "gravity follows the rotation from scan to scan"});
  f.group("noise", c.noise);
}

void describe(Fields& f, ScanMatchConfig& c) {
  f.integer("min_lines", c.min_lines, {"-", in_range(0, 100000), "needed for a step"});
  f.integer("min_planes", c.min_planes, {"-", in_range(0, 100000), "needed for a step"});
  f.group("solver", c.solver);
}

void describe(Fields& f, Config& c) {
  f.group("image", c.image);
  f.group("features", c.features);
  f.group("min_features", c.min_features);
  f.group("matching", c.matching);
  f.group("filter", c.filter);
  f.group("update", c.update);
  f.group("scan_match", c.scan_match);
  f.group("mapping", c.mapping);
  f.group("queue", c.queue);
}

Requirements requirements_of(const Config& config) {
  return {.lidar = true,
          .imu = true,
          .rings = true,
          .point_times = config.features.point_times == lego_loam::PointTimes::kMeasured,
          .range_image = {config.image.rows, config.image.row_angle_deg}};
}

Config corridor() {
  Config config;
  config.image.min_range = 0.5;
  config.mapping.loop.enabled = false;
  return config;
}

}  // namespace aims::lins
