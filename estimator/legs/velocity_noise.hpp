// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/lie.hpp"
#include "core/time.hpp"

namespace aims {

/// White-noise density of the velocity that a robot reports, learned where scans measure the way.
/// Over windows of about two strides the way by the reported velocities, their scale and bias
/// removed, is compared with the way by scans. A white noise of density q lets them differ by
/// q T in the square, T the length of the window, and slow errors count as what they do over
/// seconds. What the filter itself makes of the velocities does not enter, since a filter that
/// believes them too much would find them right.
class VelocityNoise {
 public:
  /// Adds the corrected velocity of the base in odometry axes [m/s]. It holds until the next; a gap
  /// of more than a quarter of a second begins a new window.
  void add(Time stamp, const Eigen::Vector3d& velocity);

  /// Adds the pose of the base after a scan. `measured`: scans constrain every direction of the
  /// position; where they do not, a new window begins.
  void at_scan(Time stamp, const Pose& T_odom_base, bool measured);

  /// Densities along the base axes [(m/s)^2 s]; zero before there are enough windows.
  Eigen::Vector3d density() const;

 private:
  struct Window {
    Time start;
    Eigen::Vector3d position;                       ///< of the base at the start, odometry axes [m]
    Eigen::Vector3d way = Eigen::Vector3d::Zero();  ///< by legs since then [m]
  };

  void advance(Time stamp);

  std::optional<Window> window_;
  std::optional<Time> packet_;  ///< the last one
  Time known_until_ = 0;        ///< end of the way by legs
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  int windows_ = 0;
  Eigen::Vector3d density_ = Eigen::Vector3d::Zero();
};

}  // namespace aims
