// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/attitude.hpp"

#include <algorithm>
#include <cmath>

#include "core/lie.hpp"

namespace aims::lio_sam {
namespace {

/// Attitudes with a greater pitch are not used [rad].
constexpr double kSteepPitch = 1.4;

}  // namespace

RollPitchYaw angles_of(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d R = rotation.toRotationMatrix();
  return {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
          std::atan2(R(1, 0), R(0, 0))};
}

Eigen::Quaterniond rotation_of(const RollPitchYaw& angles) {
  return Eigen::AngleAxisd(angles.yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.roll, Eigen::Vector3d::UnitX());
}

Eigen::Quaterniond levelled(const Eigen::Quaterniond& rotation, const RollPitchYaw& attitude,
                            double weight) {
  if (std::abs(attitude.pitch) >= kSteepPitch) return rotation;
  RollPitchYaw angles = angles_of(rotation);
  angles.roll += weight * wrap_angle(attitude.roll - angles.roll);
  angles.pitch += weight * wrap_angle(attitude.pitch - angles.pitch);
  return rotation_of(angles);
}

}  // namespace aims::lio_sam
