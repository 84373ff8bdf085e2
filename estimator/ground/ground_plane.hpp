// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/config.hpp"

namespace aims {

/// Ground constraint: when the ground counts as level, and how accurate a level ground is.
struct GroundConstraintConfig {
  bool enabled = false;
  double radius = 6.0;              ///< horizontal radius of the points used [m]
  double min_height = 0.15;         ///< of the body above the ground [m]
  double max_height = 1.2;          ///< of the body above the ground [m]
  double max_slope = 0.15;          ///< of the ground in body axes, for candidate points [-]
  double band = 0.04;               ///< inliers are this close to the plane [m]
  int min_points = 60;              ///< inliers of a ground plane
  double min_spread = 0.25;         ///< smallest deviation of the inliers, any direction [m]
  double max_residual = 0.015;      ///< root mean square distance of the inliers [m]
  double max_bend = 0.02;           ///< of a part of the ground from the plane [m]
  double min_tilt_gate = 7.5e-3;    ///< ground tilted by less is level [rad]
  double max_tilt_gate = 1.5e-2;    ///< ground tilted by more is not, however uncertain [rad]
  double max_step = 0.05;           ///< a larger change of height starts another level [m]
  double settling_distance = 1.0;   ///< on level ground before it is used again [m]
  double spacing = 0.03;            ///< distance between measurements [m]
  double correlation_length = 0.7;  ///< of the unevenness [m]
  double sigma_tilt = 1e-3;         ///< unevenness of level ground, per axis [rad]
  double sigma_height = 5e-3;       ///< unevenness of level ground [m]
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
  /// Of the normal, from the scatter of the inliers: 3x3, body axes, zero along the normal [rad^2].
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();
};

/// The lowest wide plane below a robot that stands roughly upright: a mode of the point heights
/// near the robot, then least squares within a band that shrinks to `config.band`. Empty when the
/// inliers are few, badly spread or scattered, or the height is out of range. Deterministic.
/// `points` are deskewed returns in body axes at the scan's end [m].
std::optional<GroundPlane> fit_ground(std::span<const Eigen::Vector3f> points,
                                      const GroundConstraintConfig& config);

}  // namespace aims
