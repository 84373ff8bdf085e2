// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/lie.hpp"
#include "core/time.hpp"

namespace aims {

/// White-noise density of the velocity that a robot reports, learned where scans constrain every
/// direction. Over windows of about two strides the displacement integrated from the reported
/// velocities, corrected by leg scale and bias, is compared with the displacement between the poses
/// after the scans. White noise of density q gives a mean squared difference of q T over a window
/// of length T; errors that vary more slowly count by what they do over a window. Innovations of
/// the filter would not do: a filter that trusts the velocities too much finds them consistent.
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
    Eigen::Vector3d position;  ///< of the base at the start, odometry axes [m]
    Eigen::Vector3d by_legs = Eigen::Vector3d::Zero();  ///< displacement since then [m]
  };

  void advance(Time stamp);

  std::optional<Window> window_;
  std::optional<Time> packet_;  ///< the last one
  Time known_until_ = 0;        ///< until which velocities are integrated
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  int windows_ = 0;
  Eigen::Vector3d density_ = Eigen::Vector3d::Zero();
};

}  // namespace aims
