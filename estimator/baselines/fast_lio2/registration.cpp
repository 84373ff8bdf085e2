// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/registration.hpp"

#include <Eigen/QR>
#include <cmath>

namespace aims::fast_lio2 {

std::optional<FittedPlane> fit_plane(const Neighbours& neighbours, double threshold) {
  Eigen::Matrix<float, kNeighbours, 3> A;
  for (int i = 0; i < kNeighbours; ++i) {
    A.row(i) = neighbours.points[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix<float, kNeighbours, 1> b = -Eigen::Matrix<float, kNeighbours, 1>::Ones();
  const Eigen::Vector3f solution = A.colPivHouseholderQr().solve(b);
  const float norm = solution.norm();
  const FittedPlane plane{solution / norm, 1.0F / norm};
  for (const Eigen::Vector3f& point : neighbours.points) {
    // Written so that a NaN, from neighbours without a solution, is refused as well.
    if (!(std::abs(plane.distance(point)) <= static_cast<float>(threshold))) return std::nullopt;
  }
  return plane;
}

PointResidual point_residual(const State& x, const Eigen::Vector3f& p_lidar,
                             const FittedPlane& plane, bool estimate_extrinsic) {
  const Eigen::Vector3d point = p_lidar.cast<double>();
  const Eigen::Vector3d p_body = x.T_body_lidar * point;
  const Eigen::Vector3d normal = plane.normal.cast<double>();
  const Eigen::Vector3d normal_in_body = x.T_world_body.rotation.conjugate() * normal;
  PointResidual row;
  row.distance = plane.distance(to_world(x, p_lidar).cast<float>());
  row.jacobian.setZero();
  row.jacobian.segment<3>(Error::kPosition) = normal;
  row.jacobian.segment<3>(Error::kRotation) = p_body.cross(normal_in_body);
  if (estimate_extrinsic) {
    const Eigen::Vector3d normal_in_lidar = x.T_body_lidar.rotation.conjugate() * normal_in_body;
    row.jacobian.segment<3>(Error::kMountRotation) = point.cross(normal_in_lidar);
    row.jacobian.segment<3>(Error::kMountTranslation) = normal_in_body;
  }
  return row;
}

Registration::Registration(std::span<const Eigen::Vector3f> points, const PointMap& map,
                           const Residuals& residuals, bool estimate_extrinsic)
    : points_(points),
      map_(map),
      config_(residuals),
      estimate_extrinsic_(estimate_extrinsic),
      neighbours_(points.size()),
      selected_(points.size(), 0) {}

const ScanResiduals& Registration::evaluate(const State& x, bool search) {
  used_.clear();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (search) {
      neighbours_[i] = map_.nearest(to_world(x, points_[i]).cast<float>());
      selected_[i] = neighbours_[i].count == kNeighbours &&
                     neighbours_[i].squared_distances.back() <= config_.max_squared_distance;
    }
    if (selected_[i] == 0) continue;
    selected_[i] = 0;
    const std::optional<FittedPlane> plane = fit_plane(neighbours_[i], config_.plane_threshold);
    if (!plane) continue;
    const PointResidual row = point_residual(x, points_[i], *plane, estimate_extrinsic_);
    const double range = points_[i].norm();
    const double score = 1.0 - config_.score_slope * std::abs(row.distance) / std::sqrt(range);
    if (!(score > config_.min_score)) continue;
    selected_[i] = 1;
    used_.push_back(row);
  }
  const auto rows = static_cast<Eigen::Index>(used_.size());
  result_.distances.resize(rows);
  result_.jacobian.resize(rows, Error::kMeasured);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const PointResidual& row = used_[static_cast<std::size_t>(i)];
    result_.distances(i) = row.distance;
    result_.jacobian.row(i) = row.jacobian.transpose();
  }
  return result_;
}

}  // namespace aims::fast_lio2
