// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/attitude_filter.hpp"

#include <algorithm>

#include "core/lie.hpp"

namespace aims {
namespace {

constexpr double kLevellingRate = 0.2;  ///< of roll and pitch towards the felt gravity [1/s]
constexpr double kLongestStep = 0.5;    ///< a longer gap says nothing of the rotation in it [s]

}  // namespace

Eigen::Quaterniond AttitudeFilter::update(const ImuSample& sample) {
  const Eigen::Vector3d up_felt = sample.specific_force.normalized();
  if (!last_) {
    rotation_ = Eigen::Quaterniond::FromTwoVectors(up_felt, Eigen::Vector3d::UnitZ());
    rotation_ = yaw_rotation(-yaw_of(rotation_)) * rotation_;
  } else {
    const double step = std::clamp(to_seconds(sample.stamp - *last_), 0.0, kLongestStep);
    rotation_ = rotation_ * so3_exp(sample.angular_velocity * step);
    const Eigen::Vector3d up_believed = rotation_.conjugate() * Eigen::Vector3d::UnitZ();
    rotation_ = rotation_ * so3_exp(kLevellingRate * step * up_felt.cross(up_believed));
    rotation_.normalize();
  }
  last_ = sample.stamp;
  return rotation_;
}

}  // namespace aims
