// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/registration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace aims::bievr {
namespace {

Pose step_of(const Vector6& delta) { return {so3_exp(delta.head<3>()), delta.tail<3>()}; }

bool is_small(const Pose& step, const RegistrationConfig& config) {
  const double rotation = (step.R() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return rotation < config.rotation_epsilon &&
         step.translation.cwiseAbs().maxCoeff() < config.position_epsilon;
}

double huber(double r, double limit) {
  const double size = std::abs(r);
  return size <= limit ? 0.5 * r * r : limit * (size - 0.5 * limit);
}

/// The cost alone.
double cost_at(const BumpMap& map, const Pose& T_world_body,
               std::span<const Eigen::Vector3d> points, const RegistrationConfig& config) {
  const Eigen::Matrix3d R = T_world_body.R();
  double cost = 0.0;
  for (const Eigen::Vector3d& p_body : points) {
    const Eigen::Vector3d p_world = R * p_body + T_world_body.translation;
    const BumpVoxel* voxel = map.nearest(p_world);
    if (voxel == nullptr) continue;
    const Eigen::Vector3d at = voxel->image.in_image(p_world);
    const auto height = config.relief ? voxel->image.height(at.head<2>()) : std::optional(0.0);
    if (height) cost += huber(at.z() - *height, config.huber);
  }
  return cost;
}

enum class Outcome { kMoved, kAtMinimum, kStuck };

/// One accepted step, or none that lowers the cost. `damping` is added to the diagonal of the
/// Hessian; negative: not known yet.
Outcome step(const BumpMap& map, std::span<const Eigen::Vector3d> points,
             const RegistrationConfig& config, double& damping, Registered& result) {
  const LinearCost& linear = result.last = linearize(map, result.T_world_body, points, config);
  if (damping < 0.0) {
    damping = config.first_damping * linear.hessian.diagonal().cwiseAbs().maxCoeff();
  }
  double growth = 2.0;
  for (int i = 0; i < config.max_attempts; ++i) {
    const Matrix6 damped = linear.hessian + damping * Matrix6::Identity();
    const Vector6 delta = damped.ldlt().solve(-linear.gradient);
    const Pose change = step_of(delta);
    if (!delta.allFinite()) return Outcome::kStuck;
    Pose next = result.T_world_body * change;
    next.rotation.normalize();
    const double gain = linear.cost - cost_at(map, next, points, config);
    const double ratio = gain / delta.dot(damping * delta - linear.gradient);
    if (ratio < 0.0) {
      if (is_small(change, config)) return Outcome::kAtMinimum;
      damping *= growth;
      growth *= 2.0;
      continue;
    }
    result.T_world_body = next;
    damping *= std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3));
    return is_small(change, config) ? Outcome::kAtMinimum : Outcome::kMoved;
  }
  return Outcome::kStuck;
}

}  // namespace

std::optional<Residual> residual(const BumpMap& map, const Pose& T_world_body,
                                 const Eigen::Matrix3d& R, const Eigen::Vector3d& p_body,
                                 bool relief) {
  const Eigen::Vector3d p_world = R * p_body + T_world_body.translation;
  const BumpVoxel* voxel = map.nearest(p_world);
  if (voxel == nullptr) return std::nullopt;
  const Eigen::Vector3d at = voxel->image.in_image(p_world);
  const auto surface = relief ? voxel->image.sample(at.head<2>()) : std::optional(Height());
  if (!surface) return std::nullopt;
  // The normal of the relief times the cosine of its slope, in body axes.
  const Eigen::Vector3d n_image(-surface->slope.x(), -surface->slope.y(), 1.0);
  const Eigen::Vector3d n_body =
      R.transpose() * (voxel->image.R_image_world().transpose() * n_image);
  Residual result;
  result.value = at.z() - surface->value;
  result.jacobian << p_body.cross(n_body), n_body;
  return result;
}

LinearCost linearize(const BumpMap& map, const Pose& T_world_body,
                     std::span<const Eigen::Vector3d> points, const RegistrationConfig& config) {
  const Eigen::Matrix3d R = T_world_body.R();
  LinearCost sum;
  for (const Eigen::Vector3d& p_body : points) {
    const auto r = residual(map, T_world_body, R, p_body, config.relief);
    if (!r) continue;
    const double size = std::abs(r->value);
    const double weight = size <= config.huber ? 1.0 : config.huber / size;
    ++sum.used;
    sum.absolute += size;
    sum.cost += huber(r->value, config.huber);
    sum.hessian.noalias() += weight * r->jacobian * r->jacobian.transpose();
    sum.gradient += weight * r->value * r->jacobian;
  }
  return sum;
}

Registered registered(const BumpMap& map, const Pose& start,
                      std::span<const Eigen::Vector3d> points, const RegistrationConfig& config) {
  Registered result;
  result.T_world_body = start;
  double damping = -1.0;
  while (result.iterations < config.max_iterations) {
    const Outcome outcome = step(map, points, config, damping, result);
    if (result.last.used == 0) return result;
    if (outcome == Outcome::kStuck) return result;
    ++result.iterations;
    if (outcome == Outcome::kAtMinimum) {
      result.converged = true;
      return result;
    }
  }
  return result;
}

}  // namespace aims::bievr
