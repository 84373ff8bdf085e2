// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "estimator/baselines/fast_lio2/config.hpp"
#include "estimator/baselines/fast_lio2/point_map.hpp"
#include "estimator/baselines/fast_lio2/prediction.hpp"
#include "estimator/baselines/fast_lio2/state.hpp"

namespace aims::fast_lio2 {

/// A plane n . p + d = 0 with unit normal n.
struct FittedPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float offset = 0.0F;  ///< d [m]

  float distance(const Eigen::Vector3f& p) const { return normal.dot(p) + offset; }
};

/// The plane through the neighbours: least squares of n . p = -1 with n scaled to a unit vector,
/// in single precision as published. Empty when a neighbour is further than `threshold` [m] away.
std::optional<FittedPlane> fit_plane(const Neighbours& neighbours, double threshold);

/// One point against its plane.
struct PointResidual {
  double distance = 0.0;  ///< of the point in the world from the plane, signed [m]
  Eigen::Matrix<double, Error::kMeasured, 1> jacobian;  ///< of the distance in the error state
};

/// Distance and Jacobian for a point in LiDAR axes; the entries of the mount are zero unless the
/// extrinsic is estimated.
PointResidual point_residual(const State& x, const Eigen::Vector3f& p_lidar,
                             const FittedPlane& plane, bool estimate_extrinsic);

/// The residuals of a scan.
struct ScanResiduals {
  Eigen::VectorXd distances;  ///< [m]
  Eigen::Matrix<double, Eigen::Dynamic, Error::kMeasured> jacobian;
};

/// Associates the points of one scan with planes of the map.
class Registration {
 public:
  /// `points`: LiDAR axes at the scan's end. The arguments must outlive it.
  Registration(std::span<const Eigen::Vector3f> points, const PointMap& map,
               const Residuals& residuals, bool estimate_extrinsic);

  /// The residuals at `x`. With `search`, neighbours are looked up again; without, the last ones
  /// stay, and a point that was left out stays left out.
  const ScanResiduals& evaluate(const State& x, bool search);

  /// Neighbours of each point at its last search.
  std::span<const Neighbours> neighbours() const { return neighbours_; }

 private:
  std::span<const Eigen::Vector3f> points_;
  const PointMap& map_;
  Residuals config_;
  bool estimate_extrinsic_;
  std::vector<Neighbours> neighbours_;
  std::vector<char> selected_;
  std::vector<PointResidual> used_;
  ScanResiduals result_;
};

/// A point of the LiDAR in the world.
inline Eigen::Vector3d to_world(const State& x, const Eigen::Vector3f& p_lidar) {
  return x.T_world_body * (x.T_body_lidar * p_lidar.cast<double>());
}

/// The result of an iterated update.
struct Update {
  Belief belief;
  int iterations = 0;            ///< with residuals; 0: no update
  bool converged = false;        ///< the last step was within the limit
  ScanResiduals residuals = {};  ///< of the last iteration, before its step
};

/// Residuals at a state; `search`: associate again.
using ResidualsAt = std::function<const ScanResiduals&(const State&, bool search)>;

/// The iterated Kalman update on the manifold (FAST-LIO2, eqs. 18-20). Each iteration moves the
/// prior's covariance to the tangential space of the present state and steps by
///   K z - (I - K H) J (x [-] x_prior),  K = (H^T H + (P / R)^-1)^-1 H^T.
/// Points are associated again only after a step within the limit, as in the published program, and
/// before the last iteration. The covariance follows from the last iteration.
Update iterated_update(const Belief& prior, const ResidualsAt& residuals, double variance,
                       const Iterations& config);

}  // namespace aims::fast_lio2
