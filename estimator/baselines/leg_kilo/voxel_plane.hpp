// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "estimator/baselines/leg_kilo/config.hpp"

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

/// A voxel of the map: a plane, or where its points lie on none, eight smaller voxels with planes.
class PlaneTree {
 public:
  /// A voxel with that centre and edge [m].
  PlaneTree(const Eigen::Vector3d& centre, double edge, int layer = 0)
      : centre_(centre), edge_(edge), layer_(layer) {}

  /// Adds a point of the first scan, without a plane yet.
  void collect(const MapPoint& point) { points_.push_back(point); }

  /// Gives the points collected their planes.
  void build(const Map& config);

  /// Adds a point and renews the plane that it belongs to when that is due.
  void add(const MapPoint& point, const Map& config);

  const Eigen::Vector3d& centre() const { return centre_; }
  double edge() const { return edge_; }
  const std::optional<VoxelPlane>& plane() const { return plane_; }

  /// Calls `visit` with each plane; those below a plane are not in use.
  template <class Visit>
  void visit_planes(const Visit& visit) const {
    if (plane_) {
      visit(*plane_);
      return;
    }
    for (const auto& child : children_) {
      if (child) child->visit_planes(visit);
    }
  }

 private:
  PlaneTree& child_of(const Eigen::Vector3d& point);
  void fit(const Map& config);
  void divide(const Map& config);
  void add_to_plane(const MapPoint& point, const Map& config);
  void finish();

  Eigen::Vector3d centre_;
  double edge_;
  int layer_;
  std::vector<MapPoint> points_;  ///< of the plane, until it is final
  int new_points_ = 0;            ///< since the last fit
  bool built_ = false;            ///< enough points have come once
  bool final_ = false;            ///< no further points are taken
  std::optional<VoxelPlane> plane_;
  std::array<std::unique_ptr<PlaneTree>, 8> children_;
};

}  // namespace aims::leg_kilo
