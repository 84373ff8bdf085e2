// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/measurements.hpp"
#include "recordings/reading_notes.hpp"

namespace aims {

/// Compares an odometry's twist with its pose. By ROS's convention the twist is in base axes, but
/// some drivers use the axes of the odometry frame.
class TwistCheck {
 public:
  /// True at the end of a second of motion that only a twist in odometry axes explains.
  bool add(const LegOdometrySample& sample);
  /// Where twist and pose contradict each other otherwise.
  std::optional<ReadingWarning> warning() const;

 private:
  /// What pose and twist say of the seconds in which either moves.
  struct Sums {
    int windows = 0, in_odometry_axes = 0;
    double seconds = 0.0;
    Eigen::Vector3d by_pose = Eigen::Vector3d::Zero();   ///< in base axes [m] or [rad]
    Eigen::Vector3d by_twist = Eigen::Vector3d::Zero();  ///< likewise
    double length_by_pose = 0.0, length_by_twist = 0.0;  ///< of all windows
    double way = 0.0, apart = 0.0;                       ///< sums of lengths, and of differences
  };
  void compare(const LegOdometrySample& sample, double seconds);
  static void add_to(Sums& sums, const Eigen::Vector3d& by_pose, const Eigen::Vector3d& by_twist,
                     double seconds);

  std::optional<LegOdometrySample> start_, last_;
  Eigen::Vector3d by_base_axes_ = Eigen::Vector3d::Zero();  ///< displacement since the start [m]
  Eigen::Vector3d by_odometry_axes_ =
      Eigen::Vector3d::Zero();                        ///< displacement since the start [m]
  Eigen::Vector3d turned_ = Eigen::Vector3d::Zero();  ///< by the twist since the start [rad]
  Sums moving_, turning_;
};

}  // namespace aims
