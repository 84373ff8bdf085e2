// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "estimator/aims/directional_config.hpp"

namespace aims {

/// The floor around the robot as one scan sees it, body axes at the scan's end: the points p with
/// normal . p + height = 0.
struct FloorPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, away from the floor
  double height = 0.0;                                ///< of the body above the floor [m]
  int points = 0;                                     ///< within the band about the plane
  double residual = 0.0;  ///< root mean square distance of these from the plane [m]
  double bend = 0.0;      ///< largest median height of a part of the floor over the plane [m]
  /// Of the normal, by the scatter of the points: 3x3, body axes, zero across the normal [rad^2].
  Eigen::Matrix3d normal_covariance = Eigen::Matrix3d::Zero();
};

/// The lowest wide plane under a robot that stands about upright on it: a mode of the points'
/// heights near the robot, then least squares within a band that shrinks to `config.band`. Empty
/// when too few points lie on it, they do not span it, scatter too much, or it lies where no floor
/// can be. Deterministic.
/// `points` are deskewed returns in body axes at the scan's end [m].
std::optional<FloorPlane> fit_floor(std::span<const Eigen::Vector3f> points,
                                    const FloorConfig& config);

}  // namespace aims
