// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/twist_check.hpp"

#include <utility>

namespace aims {
namespace {

constexpr double kWindow = 1.0;       ///< [s]
constexpr double kMaxStep = 0.1;      ///< a longer gap restarts the window [s]
constexpr double kMinDistance = 0.2;  ///< shortest displacement of a window that is tested [m]
constexpr double kMinRejectedError = 0.15;  ///< relative error of the rejected axes, at least
constexpr double kMaxAcceptedError = 0.2;   ///< relative error of the accepted axes, at most
constexpr double kMinRatio = 3.0;           ///< of both

}  // namespace

bool TwistCheck::add(const LegOdometrySample& sample) {
  const auto before = std::exchange(last_, sample);
  const double step = before ? to_seconds(sample.stamp - before->stamp) : -1.0;
  if (!start_ || !(step > 0.0) || step > kMaxStep) {
    start_ = sample;
    by_base_axes_.setZero();
    by_odometry_axes_.setZero();
    return false;
  }
  by_base_axes_ += step * (sample.T_odom_base.rotation * sample.linear_velocity);
  by_odometry_axes_ += step * sample.linear_velocity;
  if (to_seconds(sample.stamp - start_->stamp) < kWindow) return false;
  const Eigen::Vector3d moved = sample.T_odom_base.translation - start_->T_odom_base.translation;
  const double length = moved.norm();
  const double by_base = (by_base_axes_ - moved).norm();
  const double by_odometry = (by_odometry_axes_ - moved).norm();
  const bool in_odometry_axes = length > kMinDistance && by_base > kMinRejectedError * length &&
                                by_odometry < kMaxAcceptedError * length &&
                                by_base > kMinRatio * by_odometry;
  start_ = sample;
  by_base_axes_.setZero();
  by_odometry_axes_.setZero();
  return in_odometry_axes;
}

}  // namespace aims
