// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace aims {

/// Tells the unit of roll, pitch and yaw without one. Radians go beyond 2 pi only where a yaw is
/// unwrapped: from a first one that is not, and no faster than robots turn.
class AngleUnit {
 public:
  void add(double stamp, const Eigen::Vector3d& angles) {
    constexpr double kWindow = 0.5;  // [s]
    if (!angles.allFinite() || !std::isfinite(stamp)) return;
    largest_ = std::max(largest_, angles.cwiseAbs().maxCoeff());
    const bool is_wide = angles.head<2>().cwiseAbs().maxCoeff() > kTurn;
    is_no_radian_ = is_no_radian_ || is_wide || (!since_ && largest_ > kTurn);
    const double passed = since_ ? stamp - *since_ : kWindow;
    if (passed < kWindow) return;
    if (since_) fastest_ = std::max(fastest_, (angles - angles_).norm() / passed);
    since_ = stamp;
    angles_ = angles;
  }

  bool is_beyond_turn() const { return largest_ > kTurn; }
  bool is_degrees() const { return is_beyond_turn() && (is_no_radian_ || fastest_ > kTurn); }
  double largest() const { return largest_; }

 private:
  static constexpr double kTurn = 2.0 * std::numbers::pi;  ///< also a second: faster than robots
  double largest_ = 0.0, fastest_ = 0.0;                   ///< as they are written
  bool is_no_radian_ = false;
  std::optional<double> since_;
  Eigen::Vector3d angles_ = Eigen::Vector3d::Zero();
};

}  // namespace aims
