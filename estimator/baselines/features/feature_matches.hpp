// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/lie.hpp"
#include "estimator/filter/error_state.hpp"

namespace aims::features {

/// A point of the scan and the line that it is to lie on. The line is in target axes.
struct LineMatch {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< scan axes [m]
  double fraction = 1.0;                                 ///< of the pose, at which it was measured
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< of the line [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< of the line, unit
};

/// A point of the scan and the plane that it is to lie on, n . x + d = 0 in target axes.
struct PlaneMatch {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< scan axes [m]
  double fraction = 1.0;                              ///< of the pose, at which it was measured
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< n, unit
  double offset = 0.0;                                ///< d [m]
};

struct FeatureMatches {
  std::vector<LineMatch> lines;
  std::vector<PlaneMatch> planes;

  int size() const { return static_cast<int>(lines.size() + planes.size()); }
};

/// Distance of a matched point from its line or plane.
struct DistanceRow {
  double distance = 0.0;                               ///< [m], of a plane with sign
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< of the distance in the point, unit
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();       ///< R p, from the sensor to the point [m]
  double range = 0.0;                                  ///< of the point in target axes [m]

  /// Derivative in the rotation and position of the pose: R Exp-left-perturbed, t added.
  Vector6 jacobian() const {
    Vector6 row;
    row << arm.cross(gradient), gradient;
    return row;
  }
};

/// The part `fraction` of the motion `pose` from the identity.
inline Pose part_of(const Pose& pose, double fraction) {
  return fraction == 1.0 ? pose : interpolate(Pose(), pose, fraction);
}

/// The pose after a step: rotation vector about target axes [rad], then translation [m].
Pose moved(const Pose& pose, const Vector6& step);

/// The distance at the pose T_target_scan.
DistanceRow distance_row(const LineMatch& match, const Pose& pose);
DistanceRow distance_row(const PlaneMatch& match, const Pose& pose);

/// How the weight of a distance falls with the distance (LOAM, section V-C).
struct DistanceWeight {
  double slope = 0.0;  ///< weight = 1 - slope |d|, of a plane |d| / sqrt(range) [1/m]
  double least = 0.0;  ///< distances of no more weight are left out
};

/// Takes the point in scan axes, its distance and the weight of it.
using TakeDistance =
    std::function<void(const Eigen::Vector3d& point, const DistanceRow& row, double weight)>;

/// Hands over the distances at the pose T_target_scan that are not zero and weigh enough.
void weighted_distances(const FeatureMatches& matches, const Pose& pose,
                        const DistanceWeight& weighting, const TakeDistance& take);

}  // namespace aims::features
