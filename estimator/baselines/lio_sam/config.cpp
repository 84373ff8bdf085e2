// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/config.hpp"

namespace aims::lio_sam {

void describe(Fields& f, TimingConfig& c) {
  f.integer("held_scans", c.held_scans,
            {"-", in_range(0, 10), "a scan is processed when this many later ones have ended"});
  f.number("delay", c.delay,
           {"s", in_range(0.0, 10.0), "until a registered scan reaches the IMU odometry"});
}

void describe(Fields& f, Config& c) {
  f.group("image", c.image);
  f.group("features", c.features);
  f.group("mapping", c.mapping);
  f.group("imu", c.imu);
  f.group("timing", c.timing);
  f.group("queue", c.queue);
}

Requirements requirements_of(const Config&) {
  return {.lidar = true, .imu = true, .rings = true, .point_times = true, .orientation = true};
}

Config corridor() {
  Config config;
  config.image.min_range = 0.5;
  config.features.surface_voxel = 0.2;
  config.mapping.edge_voxel = 0.1;
  config.mapping.surface_voxel = 0.2;
  config.mapping.loop.voxel = 0.2;
  return config;
}

}  // namespace aims::lio_sam
