// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace aims::leg_kilo {

/// A point of the map with its covariance, world.
struct MapPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< [m]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2]
};

/// A plane through points, with the covariance that theirs gives its normal and centre.
struct VoxelPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit vector
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< mean of the points [m]
  double radius = 0.0;  ///< deviation of the points along their longest axis [m]
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< normal, centre

  /// Of a point from the plane, signed [m].
  double distance(const Eigen::Vector3d& point) const { return normal.dot(point - centre); }

  /// Variance that the plane gives the distance of `point` [m^2].
  double distance_variance(const Eigen::Vector3d& point) const;
};

/// The derivative of normal and centre of the plane through `count` points in one of them, whose
/// offset from the centre is `offset`; `axes` and `eigenvalues` are those of the covariance of the
/// points, in increasing order.
Eigen::Matrix<double, 6, 3> plane_derivative(const Eigen::Vector3d& offset,
                                             const Eigen::Matrix3d& axes,
                                             const Eigen::Vector3d& eigenvalues, double count);

/// The plane through the points; empty when their covariance has no eigenvalue below
/// `max_eigenvalue` [m^2], or is no number.
std::optional<VoxelPlane> fit_plane(std::span<const MapPoint> points, double max_eigenvalue);

}  // namespace aims::leg_kilo
