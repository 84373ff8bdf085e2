// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace aims {

/// The half of an IMU that a topic has by its name.
enum class InertialHalf { kGyro, kAccelerometer };

/// The half, and the name without the word that tells it, by which two halves are a pair.
struct NamedHalf {
  InertialHalf half;
  std::string rest;
};

/// Of "/camera/gyro/sample" the gyro, of "/imu/acceleration" the accelerometer; nothing for a topic
/// whose name has neither word, or both.
std::optional<NamedHalf> inertial_half(std::string_view topic);

}  // namespace aims
