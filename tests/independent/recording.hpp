// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/measurements.hpp"

namespace aims::independent {

struct RecordingOptions {
  std::string cell = "doors_30";
  double imu_rate_hz = 200.0;
  std::uint64_t seed = 1;
  double length = 0.0;  ///< of the route, one way; 0: that of the cell [m]
  double legs_scale = 1.045;
  std::string rings = "uneven";
  double relief = 0.0;        ///< of the walls, standard deviation [m]
  double range_noise = 0.02;  ///< of the LiDAR [m]
  double outliers = 0.002;    ///< fraction of LiDAR returns
  double vibration = 1.0;     ///< factor on that of the IMU
  bool compress = false;      ///< chunks with lz4
};

/// Mounts of the sensors.
SensorRig rig_of(const RecordingOptions& options);

/// Generates the recording and writes NAME.bag, NAME.truth.tum and NAME.waypoint_times.csv as
/// `aims simulate` does. Files of those names are replaced. Error: bad options, or not written.
Result<void> write_recording(const RecordingOptions& options, const std::filesystem::path& bag);

}  // namespace aims::independent
