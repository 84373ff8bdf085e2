// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bench/estimate/lidar_odometry.hpp"
#include "core/measurements.hpp"
#include "recordings/stream/recording_reader.hpp"

namespace aims {

/// A warning where the legs go the opposite way of these paths of the LiDAR; where LiDAR odometry
/// sees little of the way, as in a corridor, nothing is judged.
std::optional<ReadingWarning> check_way(std::span<const Trajectory> paths,
                                        std::span<const LegOdometrySample> legs,
                                        const SensorRig& rig);

/// Runs LiDAR odometry over the first six seconds of scans of a walk, and compares its way with
/// that of the legs.
class WayCheck {
 public:
  explicit WayCheck(const RecordingSetup& setup);

  void consume(std::span<const Delivery> deliveries);
  std::optional<ReadingWarning> warning() const;

 private:
  void take(const LegOdometrySample& sample);

  SensorRig rig_;
  bool wanted_ = false;  ///< there are a LiDAR and legs, and scans are still to come
  std::optional<Time> walking_since_, last_walk_;
  LidarOdometry odometry_;
  int scans_ = 0;
  std::vector<LegOdometrySample> legs_;
};

}  // namespace aims
