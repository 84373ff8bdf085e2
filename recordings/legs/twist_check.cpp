// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/twist_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/lie.hpp"

namespace aims {
namespace {

constexpr double kWindow = 1.0;       ///< [s]
constexpr double kMaxStep = 0.1;      ///< a longer gap restarts the window [s]
constexpr double kMinDistance = 0.2;  ///< shortest displacement of a window that is tested [m]
constexpr double kMinRejectedError = 0.15;  ///< relative error of the rejected axes, at least
constexpr double kMaxAcceptedError = 0.2;   ///< relative error of the accepted axes, at most
constexpr double kMinRatio = 3.0;           ///< of both

constexpr double kMinTurn = 0.2;           ///< least turn of a window that is compared [rad]
constexpr int kFewestWindows = 5;          ///< that a judgement needs
constexpr double kMaxContradiction = 0.4;  ///< of the way, for slips of an odometry

std::string text_of(const Eigen::Vector3d& v) {
  const Eigen::Vector3d shown = (v.array().abs() < 5e-3).select(0.0, v);
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", shown.x(), shown.y(), shown.z());
}

}  // namespace

void TwistCheck::add_to(Sums& sums, const Eigen::Vector3d& by_pose, const Eigen::Vector3d& by_twist,
                        double seconds) {
  ++sums.windows;
  sums.seconds += seconds;
  sums.by_pose += by_pose;
  sums.by_twist += by_twist;
  sums.length_by_pose += by_pose.norm();
  sums.length_by_twist += by_twist.norm();
  sums.way += std::max(by_pose.norm(), by_twist.norm());
  sums.apart += (by_pose - by_twist).norm();
}

/// Adds what pose and twist say since the start of the window.
void TwistCheck::compare(const LegOdometrySample& sample, double seconds) {
  const Pose moved = start_->T_odom_base.inverse() * sample.T_odom_base;
  const Eigen::Vector3d by_twist = start_->T_odom_base.rotation.conjugate() * by_base_axes_;
  if (std::max(moved.translation.norm(), by_twist.norm()) > kMinDistance) {
    add_to(moving_, moved.translation, by_twist, seconds);
  }
  const Eigen::Vector3d turned = so3_log(moved.rotation);
  if (std::max(turned.norm(), turned_.norm()) > kMinTurn)
    add_to(turning_, turned, turned_, seconds);
}

std::optional<ReadingWarning> TwistCheck::warning() const {
  const auto contradicts = [](const Sums& sums) {
    return sums.windows >= kFewestWindows && sums.apart > kMaxContradiction * sums.way;
  };
  // What axes of the odometry explain is warned of as such.
  const bool moving = contradicts(moving_) && 2 * moving_.in_odometry_axes < moving_.windows;
  if (!moving && !contradicts(turning_)) return std::nullopt;
  const Sums& sums = moving ? moving_ : turning_;
  const std::string found =
      moving ? fmt::format(
                   "its mean velocity in axes of the base is {} m/s by its pose and {} by "
                   "its twist",
                   text_of(sums.by_pose / sums.seconds), text_of(sums.by_twist / sums.seconds))
             : fmt::format("it turns by {:.3g} rad by its pose and {:.3g} by its twist",
                           sums.length_by_pose, sums.length_by_twist);
  return ReadingWarning{
      "twist and pose of the leg odometry contradict each other",
      fmt::format(
          "leg odometry: over {:.0f} s {}, which estimators use: correct the driver, or use "
          "joints and contacts (topics.leg_odometry: none)",
          sums.seconds, found),
      WarnedSensor::kLegs};
}

bool TwistCheck::add(const LegOdometrySample& sample) {
  const auto before = std::exchange(last_, sample);
  const double step = before ? to_seconds(sample.stamp - before->stamp) : -1.0;
  if (!start_ || !(step > 0.0) || step > kMaxStep) {
    start_ = sample;
    by_base_axes_.setZero();
    by_odometry_axes_.setZero();
    turned_.setZero();
    return false;
  }
  by_base_axes_ += step * (sample.T_odom_base.rotation * sample.linear_velocity);
  by_odometry_axes_ += step * sample.linear_velocity;
  turned_ += step * sample.angular_velocity;
  const double seconds = to_seconds(sample.stamp - start_->stamp);
  if (seconds < kWindow) return false;
  compare(sample, seconds);
  const Eigen::Vector3d moved = sample.T_odom_base.translation - start_->T_odom_base.translation;
  const double length = moved.norm();
  const double by_base = (by_base_axes_ - moved).norm();
  const double by_odometry = (by_odometry_axes_ - moved).norm();
  const bool in_odometry_axes = length > kMinDistance && by_base > kMinRejectedError * length &&
                                by_odometry < kMaxAcceptedError * length &&
                                by_base > kMinRatio * by_odometry;
  if (in_odometry_axes) ++moving_.in_odometry_axes;
  start_ = sample;
  by_base_axes_.setZero();
  by_odometry_axes_.setZero();
  turned_.setZero();
  return in_odometry_axes;
}

}  // namespace aims
