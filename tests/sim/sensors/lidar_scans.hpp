// SPDX-License-Identifier: BSD-3-Clause
// Single scans of a LiDAR.
#pragma once

#include <cstdint>

#include "core/trajectory.hpp"
#include "sim/environment/scene_config.hpp"
#include "sim/sensors/lidar.hpp"

namespace aims::testing {

/// A VLP-16 without errors that misses nothing.
inline LidarConfig flawless_lidar() {
  LidarConfig config;
  config.range_sigma = 0.0;
  config.miss_probability = 0.0;
  config.range_at_10_percent = 1e4;
  config.body_mask_min = config.body_mask_max = Eigen::Vector3d::Zero();
  return config;
}

/// The corridor of the default scene without doors.
inline Scene plain_corridor() {
  SceneConfig config;
  config.corridor.doors.sides = WallSides::kNone;
  return build_scene(config, 1);
}

/// One pose.
inline Trajectory still(const Eigen::Vector3d& position = {40.0, 0.0, 0.45}) {
  return {{0, {Eigen::Quaterniond::Identity(), position}}};
}

/// One scan of a new LiDAR.
inline LidarScan one_scan(const Scene& scene, const LidarConfig& config, const Trajectory& poses,
                          std::uint64_t seed = 1) {
  const RayCaster caster(scene);
  return Lidar(config, caster, seed).scan(poses.front().stamp, poses);
}

}  // namespace aims::testing
