// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/registration.hpp"

#include <Eigen/LU>
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

namespace {

/// Quantities of one iteration.
struct Step {
  ErrorMatrix prior;  ///< covariance of the prior at the present state
  ErrorMatrix KH;     ///< K H
  ErrorVector error;  ///< of the state after the step
};

/// The step from `x` for the residuals there.
Step step_from(const State& x, const Belief& prior, const ScanResiduals& residuals,
               double variance) {
  const ErrorVector moved = minus(x, prior.state);
  const Transport transport(prior.state, x, moved);
  Step step;
  step.prior = transport.of_covariance(prior.covariance);
  const Eigen::Matrix<double, Error::kMeasured, Error::kMeasured> HtH =
      residuals.jacobian.transpose() * residuals.jacobian;
  ErrorMatrix information = (step.prior / variance).inverse();
  information.topLeftCorner<Error::kMeasured, Error::kMeasured>() += HtH;
  const Eigen::Matrix<double, Error::kSize, Error::kMeasured> gain =
      information.inverse().leftCols<Error::kMeasured>();  // K = gain H^T
  step.KH.setZero();
  step.KH.leftCols<Error::kMeasured>() = gain * HtH;
  const ErrorVector pulled = transport * moved;
  step.error =
      -(gain * (residuals.jacobian.transpose() * residuals.distances)) + step.KH * pulled - pulled;
  return step;
}

/// The covariance after the last step, in the tangential space of the state that it led to.
ErrorMatrix covariance_after(const Step& step, const State& before, const State& after) {
  const Transport transport(before, after, step.error);
  const ErrorMatrix prior = transport.of_covariance(step.prior);
  return prior - (transport * step.KH) * transport.on_columns(step.prior);
}

}  // namespace

Update iterated_update(const Belief& prior, const ResidualsAt& residuals, double variance,
                       const Iterations& config) {
  Update update;
  update.belief = prior;
  bool search = true;
  int small_steps = 0;
  for (int i = 0; i <= config.max; ++i) {
    const State before = update.belief.state;
    const ScanResiduals& now = residuals(before, search);
    if (now.distances.size() == 0) continue;
    const Step step = step_from(before, prior, now, variance);
    update.belief.state = plus(before, step.error);
    ++update.iterations;
    update.converged = (step.error.array().abs() <= config.convergence).all();
    small_steps += update.converged ? 1 : 0;
    search = update.converged || (small_steps == 0 && i == config.max - 1);
    if (small_steps > 1 || i == config.max) {
      update.residuals = now;
      update.belief.covariance = covariance_after(step, before, update.belief.state);
      break;
    }
  }
  return update;
}

}  // namespace aims::fast_lio2
