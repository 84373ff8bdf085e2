// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "estimator/filter/error_state.hpp"

namespace aims {

/// A plane through map points.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< n_i, unit
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< q_i, mean of the map points [m]
  bool valid = false;      ///< the points span it in two directions, more than across it
  double thickness = 0.0;  ///< largest distance of one in five of its points from it [m]

  /// Of a point from it, positive along the normal [m].
  double distance(const Eigen::Vector3d& p) const { return normal.dot(p - point); }
};

/// The map is in two halves that share no return, so that the noise of their planes is independent.
inline constexpr std::size_t kHalves = 2;

/// Planes at one place, from each half of the map.
struct PlanePair {
  Plane a;
  Plane b;
  bool valid() const { return a.valid && b.valid; }
};

/// Map points that a plane goes through.
inline constexpr std::size_t kPlanePoints = 5;
using PlanePoints = std::array<Eigen::Vector3f, kPlanePoints>;

/// The least-squares planes of the points of each half, at `query`. Valid when the points spread in
/// two directions, which five of one scan line do not, and much more than across the plane; and
/// when the query lies among them: within 1.5 of their deviations along the direction from their
/// mean to it. Beyond, and where a scan sees more of a recess than the map, the plane is a guess.
PlanePair fit_planes(const std::array<PlanePoints, kHalves>& points, const Eigen::Vector3f& query);

/// One row of the point-to-plane model.
struct PlaneRow {
  double residual = 0.0;               ///< r_i, eq. (2) [m]
  Vector6 jacobian = Vector6::Zero();  ///< of r_i in rotation and position error
};

/// Eq. (2) and its Jacobian for a point `p_body` in the body frame at the pose R, t = T_odom_body.
inline PlaneRow plane_row(const Plane& plane, const Eigen::Vector3d& p_body,
                          const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  PlaneRow row;
  row.residual = plane.distance(R * p_body + t);  // eq. (2)
  const Eigen::Vector3d normal_in_body = R.transpose() * plane.normal;
  segment(row.jacobian, ErrorState::kRotation) = p_body.cross(normal_in_body);
  segment(row.jacobian, ErrorState::kPosition) = plane.normal;
  return row;
}

}  // namespace aims
