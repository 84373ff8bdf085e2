// SPDX-License-Identifier: BSD-3-Clause
#include "core/attitude_filter.hpp"

#include <algorithm>

#include "core/lie.hpp"

namespace aims {
namespace {

constexpr double kLevellingRate = 0.2;  ///< of roll and pitch towards the measured gravity [1/s]
constexpr double kMaxStep = 0.5;        ///< rotation over a longer gap is unknown [s]

}  // namespace

Eigen::Quaterniond AttitudeFilter::update(const ImuSample& sample) {
  const Eigen::Vector3d up_measured = sample.specific_force.normalized();
  if (!last_) {
    rotation_ = Eigen::Quaterniond::FromTwoVectors(up_measured, Eigen::Vector3d::UnitZ());
    rotation_ = yaw_rotation(-yaw_of(rotation_)) * rotation_;
  } else {
    const double step = std::clamp(to_seconds(sample.stamp - *last_), 0.0, kMaxStep);
    rotation_ = rotation_ * so3_exp(sample.angular_velocity * step);
    const Eigen::Vector3d up_estimated = rotation_.conjugate() * Eigen::Vector3d::UnitZ();
    rotation_ = rotation_ * so3_exp(kLevellingRate * step * up_measured.cross(up_estimated));
    rotation_.normalize();
  }
  last_ = sample.stamp;
  return rotation_;
}

}  // namespace aims
