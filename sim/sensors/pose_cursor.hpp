// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/trajectory.hpp"

namespace aims {

/// Poses at rising times, found by walking along the trajectory: bit for bit `interpolate`, with
/// the angle between two poses of the trajectory computed once.
class PoseCursor {
 public:
  explicit PoseCursor(const Trajectory& trajectory) : trajectory_(trajectory) {}

  /// Interpolated; beyond the ends, the first or last pose.
  Pose at(Time stamp) {
    const std::size_t before = next_;
    while (next_ < trajectory_.size() && trajectory_[next_].stamp < stamp) ++next_;
    if (next_ == trajectory_.size()) return trajectory_.back().pose;
    if (next_ == 0) return trajectory_.front().pose;
    if (next_ != before) find_angle();
    return blended(to_seconds(stamp - trajectory_[next_ - 1].stamp) /
                   to_seconds(trajectory_[next_].stamp - trajectory_[next_ - 1].stamp));
  }

 private:
  /// Of the rotation between the poses around the present time.
  void find_angle() {
    cosine_ = trajectory_[next_ - 1].pose.rotation.dot(trajectory_[next_].pose.rotation);
    angle_ = std::acos(std::min(std::abs(cosine_), 1.0));
    sine_ = std::sin(angle_);
  }

  Pose blended(double fraction) const {
    const Pose& a = trajectory_[next_ - 1].pose;
    const Pose& b = trajectory_[next_].pose;
    double part_a = 1.0 - fraction;
    double part_b = fraction;
    if (std::abs(cosine_) < 1.0 - std::numeric_limits<double>::epsilon()) {
      part_a = std::sin((1.0 - fraction) * angle_) / sine_;
      part_b = std::sin(fraction * angle_) / sine_;
    }
    if (cosine_ < 0.0) part_b = -part_b;  // the shorter way round
    return {Eigen::Quaterniond(part_a * a.rotation.coeffs() + part_b * b.rotation.coeffs()),
            a.translation + fraction * (b.translation - a.translation)};
  }

  const Trajectory& trajectory_;
  std::size_t next_ = 0;
  double cosine_ = 1.0;  ///< of half the angle between the poses around the present time
  double angle_ = 0.0;   ///< half of it [rad]
  double sine_ = 0.0;
};

}  // namespace aims
