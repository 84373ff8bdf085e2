// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/baselines/lio_sam/mapping.hpp"
#include "estimator/baselines/lio_sam/scan_features.hpp"
#include "estimator/estimator_config.hpp"
#include "estimator/filter/measurement_queue.hpp"

namespace aims::lio_sam {

/// When the published program's parts get what the others have made. They run at the same time; an
/// estimator without a clock needs rules.
struct TimingConfig {
  int held_scans = 2;   ///< a scan is processed when this many later ones have ended
  double delay = 0.05;  ///< until a registered scan reaches the IMU odometry [s]
};

void describe(Fields& fields, TimingConfig& config);

/// Configuration of LIO-SAM; the defaults are those published.
struct Config {
  ImageConfig image;
  FeatureConfig features;
  MappingConfig mapping;
  ImuOdometryConfig imu;
  TimingConfig timing;
  QueueConfig queue;
};

void describe(Fields& fields, Config& config);

Requirements requirements_of(const Config& config);

/// The published voxel sizes for indoors, and returns from 0.5 m on: the walls of a corridor are
/// nearer than the published 1 m.
Config corridor();

}  // namespace aims::lio_sam
