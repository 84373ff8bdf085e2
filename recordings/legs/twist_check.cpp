// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/twist_check.hpp"

#include <utility>

namespace aims {
namespace {

constexpr double kWindow = 1.0;        ///< [s]
constexpr double kLongestStep = 0.1;   ///< a longer gap leaves the way open [s]
constexpr double kLeastWay = 0.2;      ///< in a window, to tell anything [m]
constexpr double kDisagreement = 0.5;  ///< of the way, at least
constexpr double kAgreement = 0.2;     ///< of the way, at most

}  // namespace

bool TwistCheck::add(const LegOdometrySample& sample) {
  const auto before = std::exchange(last_, sample);
  const double step = before ? to_seconds(sample.stamp - before->stamp) : -1.0;
  if (!start_ || !(step > 0.0) || step > kLongestStep) {
    start_ = sample;
    by_base_axes_.setZero();
    by_odometry_axes_.setZero();
    return false;
  }
  by_base_axes_ += step * (sample.T_odom_base.rotation * sample.linear_velocity);
  by_odometry_axes_ += step * sample.linear_velocity;
  if (to_seconds(sample.stamp - start_->stamp) < kWindow) return false;
  const Eigen::Vector3d way = sample.T_odom_base.translation - start_->T_odom_base.translation;
  const double length = way.norm();
  const bool tells = length > kLeastWay && (by_base_axes_ - way).norm() > kDisagreement * length &&
                     (by_odometry_axes_ - way).norm() < kAgreement * length;
  start_ = sample;
  by_base_axes_.setZero();
  by_odometry_axes_.setZero();
  return tells;
}

}  // namespace aims
