// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/random.hpp"
#include "estimator/lidar/scan_matcher.hpp"

namespace aims::test {

using Correspondences = std::vector<Correspondence>;

/// Adds `count` points of a rectangle with half axes `u` and `v` about `center`, unit `normal`,
/// seen level and facing along x; the residuals are those of a pose that errs by `error` (rotation,
/// then position).
inline void add_face(Correspondences& scan, int count, const Eigen::Vector3d& center,
                     const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                     const Eigen::Vector3d& normal, RandomStream& random,
                     const Vector6& error = Vector6::Zero()) {
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d p =
        center + random.uniform(-1.0, 1.0) * u + random.uniform(-1.0, 1.0) * v;
    const double residual = p.cross(normal).dot(error.head<3>()) + normal.dot(error.tail<3>());
    scan.push_back({p, normal, normal, residual});
  }
}

/// Points of a plain corridor along x, 2.2 m wide and 2.4 m high, 20 m long about the sensor.
inline Correspondences corridor(int per_face, RandomStream& random,
                                const Vector6& error = Vector6::Zero()) {
  const auto x = Eigen::Vector3d::UnitX();
  const auto y = Eigen::Vector3d::UnitY();
  const auto z = Eigen::Vector3d::UnitZ();
  Correspondences scan;
  for (const double side : {-1.0, 1.0}) {
    add_face(scan, per_face, 1.1 * side * y, 10.0 * x, 1.2 * z, -side * y, random, error);
    add_face(scan, per_face, 1.2 * side * z, 10.0 * x, 1.1 * y, -side * z, random, error);
  }
  return scan;
}

/// Adds the end wall of that corridor, ahead.
inline void add_end_wall(Correspondences& scan, int count, RandomStream& random,
                         const Vector6& error = Vector6::Zero()) {
  add_face(scan, count, {10.0, 0.0, 0.0}, {0.0, 1.1, 0.0}, {0.0, 0.0, 1.2},
           -Eigen::Vector3d::UnitX(), random, error);
}

/// Points on the six faces of a cube of 6 m about the sensor.
inline Correspondences room(int per_face, RandomStream& random,
                            const Vector6& error = Vector6::Zero()) {
  Correspondences scan;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d n = Eigen::Vector3d::Unit(axis);
    const Eigen::Vector3d u = Eigen::Vector3d::Unit((axis + 1) % 3);
    const Eigen::Vector3d v = Eigen::Vector3d::Unit((axis + 2) % 3);
    for (const double side : {-3.0, 3.0}) {
      add_face(scan, per_face, side * n, 3.0 * u, 3.0 * v, n, random, error);
    }
  }
  return scan;
}

/// The information of a scan whose residuals have the deviation `sigma`.
inline PoseMeasurement measurement_of(const Correspondences& scan, double sigma) {
  PoseMeasurement measurement;
  for (const Correspondence& each : scan) {
    Vector6 row;
    row << each.point.cross(each.normal_in_body), each.normal;
    measurement.matrix += row * row.transpose() / (sigma * sigma);
    measurement.vector += row * each.residual / (sigma * sigma);
  }
  return measurement;
}

/// A belief whose pose is known to 0.1 rad and 0.1 m per axis, correlated with everything else.
inline Belief vague_belief(RandomStream& random) {
  Belief belief;
  ErrorMatrix A;
  for (double& entry : A.reshaped()) entry = 0.02 * random.normal();
  belief.covariance = A * A.transpose() + 1e-4 * ErrorMatrix::Identity();
  return belief;
}

}  // namespace aims::test
