// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/config.hpp"

namespace aims {

/// Horizontal radius of the points used [m].
inline constexpr double kGroundRadius = 6.0;

/// Mean distance between changes of slope or height [m].
inline constexpr double kLevelDistance = 20.0;

/// Ground constraint: the floors that a robot walks on, as a prior.
struct GroundConstraintConfig {
  bool enabled = false;
  /// Unevenness of level ground, 1 sigma: a third of what DIN 18202 allows over 15 m [m].
  double sigma_height = 5e-3;
  /// Slope of ramps, 1 sigma: the 8 % that accessible ramps may have are two of it [rad].
  double sigma_slope = 0.04;

  /// Unevenness as tilt of a plane of this radius, per axis [rad].
  double sigma_tilt() const { return sigma_height / kGroundRadius; }

  /// Difference of height between two levels, 1 sigma [m].
  double sigma_level() const { return sigma_slope * kLevelDistance; }
};

void describe(Fields& fields, GroundConstraintConfig& config);

/// The ground around the robot in one scan, body axes at the scan's end: the points p with
/// normal . p + height = 0.
struct GroundPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, upward
  double height = 0.0;                                ///< of the body above the ground [m]
  int points = 0;                                     ///< inliers
  double residual = 0.0;  ///< root mean square distance of the inliers [m]
  double bend = 0.0;      ///< largest median distance of a part of the ground from the plane [m]
  double height_variance = 0.0;  ///< from the scatter of the inliers [m^2]
  /// Of the normal, from the scatter of the inliers: 3x3, body axes, zero along the normal [rad^2].
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();
};

/// Memory of fit_ground(), which keeps it from scan to scan.
struct GroundLists {
  std::vector<double> tops;                 ///< highest point of each column around the robot [m]
  std::vector<Eigen::Vector3d> candidates;  ///< points that may lie on the ground [m]
  std::vector<double> heights;              ///< of a part of the ground over the plane [m]
};

/// The lowest wide plane below a robot that stands roughly upright: a mode of the point heights
/// near the robot, then least squares within a band that shrinks to 4 cm. Empty when the inliers
/// are few, badly spread or scattered, or the height is that of no legged robot. Deterministic.
/// `points` are deskewed returns in body axes at the scan's end [m]; what `lists` hold before has
/// no effect.
std::optional<GroundPlane> fit_ground(std::span<const Eigen::Vector3f> points, GroundLists& lists);

}  // namespace aims
