// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/velocity_noise.hpp"

#include <algorithm>

namespace aims {
namespace {

/// Two strides: what alternates within a stride cancels, as it does in the filter.
constexpr Duration kWindow = kSecond;
constexpr Duration kLongestWindow = 2 * kSecond;
constexpr Duration kLongestGap = kSecond / 4;
/// Windows before a density is stated, and of its moving average: deviations of 26 and 18 %.
constexpr int kFewestWindows = 15;
constexpr int kAveragedWindows = 30;

}  // namespace

void VelocityNoise::advance(Time stamp) {
  if (!packet_) return;
  if (stamp - *packet_ > kLongestGap) window_.reset();
  if (window_) window_->by_legs += to_seconds(stamp - known_until_) * velocity_;
  known_until_ = stamp;
}

void VelocityNoise::add(Time stamp, const Eigen::Vector3d& velocity) {
  advance(stamp);
  packet_ = stamp;
  known_until_ = stamp;
  velocity_ = velocity;
}

void VelocityNoise::at_scan(Time stamp, const Pose& T_odom_base, bool measured) {
  advance(stamp);
  if (!measured || !packet_ || stamp - *packet_ > kLongestGap) {
    window_.reset();
    return;
  }
  if (window_ && stamp - window_->start < kWindow) return;
  if (window_ && stamp - window_->start <= kLongestWindow) {
    const double duration = to_seconds(stamp - window_->start);
    const Eigen::Vector3d difference =
        T_odom_base.rotation.conjugate() *
        (window_->by_legs - (T_odom_base.translation - window_->position));
    ++windows_;
    const double gain = 1.0 / std::min(windows_, kAveragedWindows);
    density_ += gain * (difference.cwiseAbs2() / duration - density_);
  }
  window_ = Window{stamp, T_odom_base.translation};
}

Eigen::Vector3d VelocityNoise::density() const {
  return windows_ < kFewestWindows ? Eigen::Vector3d::Zero() : density_;
}

}  // namespace aims
