// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/inertial_topics.hpp"

#include <array>

#include "core/text.hpp"

namespace aims {
namespace {

// Longer words first: their whole text is left out of the name.
constexpr std::array<std::string_view, 3> kGyro = {"angular_velocity", "gyroscope", "gyro"};
constexpr std::array<std::string_view, 5> kAccelerometer = {"linear_acceleration", "accelerometer",
                                                            "acceleration", "accel", "acc"};

template <std::size_t kCount>
std::optional<std::string> without(std::string name,
                                   const std::array<std::string_view, kCount>& words) {
  for (const std::string_view word : words) {
    const std::size_t at = name.find(word);
    if (at == std::string::npos) continue;
    const std::size_t end = at + word.size();
    // The short one is a whole part of the name, as in /imu/acc, and no account.
    const bool whole = at > 0 && name[at - 1] == '/' && (end == name.size() || name[end] == '/');
    if (word.size() > 3 || whole) return name.erase(at, word.size());
  }
  return std::nullopt;
}

}  // namespace

std::optional<NamedHalf> inertial_half(std::string_view topic) {
  const std::string name = lower_case(topic);
  const auto gyro = without(name, kGyro), accelerometer = without(name, kAccelerometer);
  if (gyro.has_value() == accelerometer.has_value()) return std::nullopt;
  if (gyro) return NamedHalf{InertialHalf::kGyro, *gyro};
  return NamedHalf{InertialHalf::kAccelerometer, *accelerometer};
}

}  // namespace aims
