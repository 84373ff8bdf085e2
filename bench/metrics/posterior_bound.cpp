// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/posterior_bound.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "bench/metrics/bound_model.hpp"

namespace aims {
namespace {

using bound_model::between;
using bound_model::bound_at;
using bound_model::initial_covariance;
using bound_model::leg_information;
using bound_model::Matrix;
using bound_model::step_noise;
using bound_model::transition;
using Eigen::Vector3d;

/// Covariance after independent measurements with the information `gain` about the state:
/// (P^-1 + gain)^-1, also where `gain` is singular.
Matrix informed(const Matrix& P, const Matrix& gain) {
  const Matrix sum = Matrix::Identity() + gain * P;
  const Matrix updated = sum.transpose().partialPivLu().solve(P).transpose();
  return 0.5 * (updated + updated.transpose());
}

/// Information of a scan, whose translation is in body axes, about the state.
Matrix scan_gain(const ScanInformation& scan, const Pose& T_world_body) {
  const bound_model::PoseRows H = bound_model::pose_rows(T_world_body);
  return H.transpose() * scan.information * H;
}

}  // namespace

double bound_along(const PosteriorBound& bound, const Vector3d& axis) {
  return std::sqrt(std::max(0.0, axis.dot(bound.position * axis)));
}

std::vector<PosteriorBound> posterior_bounds(std::span<const TrueMotion> motion,
                                             std::span<const ScanInformation> scans,
                                             const BoundParameters& parameters) {
  std::vector<PosteriorBound> bounds;
  if (motion.empty()) return bounds;
  Matrix P = initial_covariance(motion.front(), parameters);
  TrueMotion at = motion.front();
  const auto step_to = [&](const TrueMotion& next) {
    const double dt = to_seconds(next.stamp - at.stamp);
    if (dt <= 0.0) return;
    const Matrix F = transition(at, next, dt);
    P = F * P * F.transpose() + step_noise(parameters, dt);
    if (parameters.legs.used) P = informed(P, leg_information(next, parameters, dt));
    at = next;
  };
  auto scan = std::find_if(scans.begin(), scans.end(), [&](const ScanInformation& each) {
    return each.stamp >= motion.front().stamp;
  });
  for (const TrueMotion& next : motion) {
    for (; scan != scans.end() && scan->stamp <= next.stamp; ++scan) {
      step_to(scan->stamp == next.stamp ? next : between(at, next, scan->stamp));
      if (parameters.lidar) P = informed(P, scan_gain(*scan, at.T_world_body));
      bounds.push_back(bound_at(P, at));
    }
    step_to(next);
  }
  return bounds;
}

}  // namespace aims
