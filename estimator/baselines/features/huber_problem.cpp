// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/huber_problem.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace aims::features {
namespace {

// Defaults of the Ceres solver, ceres::Solver::Options.
constexpr double kInitialRadius = 1e4;
constexpr double kMaxRadius = 1e16;
constexpr double kMinDiagonal = 1e-6;
constexpr double kMaxDiagonal = 1e32;
constexpr double kMinRelativeDecrease = 1e-3;
constexpr double kFunctionTolerance = 1e-6;
constexpr double kGradientTolerance = 1e-10;
constexpr double kParameterTolerance = 1e-8;

double huber_loss(double squared, double delta) {
  return squared <= delta * delta ? squared : 2.0 * delta * std::sqrt(squared) - delta * delta;
}

/// Derivative of the loss in the squared distance: the weight of a residual.
double huber_weight(double squared, double delta) {
  return squared <= delta * delta ? 1.0 : delta / std::sqrt(squared);
}

void add_row(const DistanceRow& row, const Eigen::Vector3d& gradient, double fraction,
             double distance, double weight, HuberProblem::Linearized& sum) {
  Vector6 jacobian;
  jacobian << row.arm.cross(gradient), gradient;
  jacobian *= fraction;
  sum.information += weight * jacobian * jacobian.transpose();
  sum.gradient += weight * distance * jacobian;
}

/// Steps of the trust region: grows after a good step, shrinks faster with each bad one.
class TrustRegion {
 public:
  double radius() const { return radius_; }
  void accepted(double quality) {
    radius_ =
        std::min(kMaxRadius, radius_ / std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * quality - 1.0, 3)));
    divisor_ = 2.0;
  }
  void rejected() {
    radius_ /= divisor_;
    divisor_ *= 2.0;
  }

 private:
  double radius_ = kInitialRadius;
  double divisor_ = 2.0;
};

}  // namespace

double HuberProblem::cost(const Pose& pose) const {
  double sum = 0.0;
  const auto add = [&](double distance) { sum += huber_loss(distance * distance, delta_); };
  for (const LineMatch& match : matches_.lines) add(distance_row(match, pose).distance);
  for (const PlaneMatch& match : matches_.planes) add(distance_row(match, pose).distance);
  return sum / 2.0;
}

HuberProblem::Linearized HuberProblem::linearized(const Pose& pose) const {
  Linearized sum;
  for (const LineMatch& match : matches_.lines) {
    const DistanceRow row = distance_row(match, pose);
    const double squared = row.distance * row.distance;
    const double weight = huber_weight(squared, delta_);
    const Eigen::Vector3d first = match.direction.unitOrthogonal();
    const Eigen::Vector3d second = match.direction.cross(first);
    const Eigen::Vector3d across = row.distance * row.gradient;
    add_row(row, first, match.fraction, first.dot(across), weight, sum);
    add_row(row, second, match.fraction, second.dot(across), weight, sum);
    sum.cost += huber_loss(squared, delta_) / 2.0;
  }
  for (const PlaneMatch& match : matches_.planes) {
    const DistanceRow row = distance_row(match, pose);
    const double squared = row.distance * row.distance;
    add_row(row, row.gradient, match.fraction, row.distance, huber_weight(squared, delta_), sum);
    sum.cost += huber_loss(squared, delta_) / 2.0;
  }
  return sum;
}

Minimum minimize(const HuberProblem& problem, const Pose& initial, int max_iterations) {
  Minimum minimum{initial};
  HuberProblem::Linearized at = problem.linearized(initial);
  const Vector6 scale = (1.0 + at.information.diagonal().array().sqrt()).inverse();
  TrustRegion region;
  while (minimum.iterations < max_iterations) {
    if (at.gradient.cwiseAbs().maxCoeff() <= kGradientTolerance) break;
    ++minimum.iterations;
    const Matrix6 scaled = scale.asDiagonal() * at.information * scale.asDiagonal();
    const Vector6 gradient = scale.cwiseProduct(at.gradient);
    const Vector6 damping =
        scaled.diagonal().cwiseMax(kMinDiagonal).cwiseMin(kMaxDiagonal) / region.radius();
    const Matrix6 damped = scaled + Matrix6(damping.asDiagonal());
    const Vector6 step = -damped.ldlt().solve(gradient);
    const double predicted = -step.dot(gradient) - step.dot(scaled * step) / 2.0;
    const Pose candidate = moved(minimum.pose, scale.cwiseProduct(step));
    const double change = at.cost - problem.cost(candidate);
    const double size = minimum.pose.translation.norm() + 1.0;  // of position and quaternion
    if (scale.cwiseProduct(step).norm() <= kParameterTolerance * size) break;
    if (!(predicted > 0.0) || !(change / predicted > kMinRelativeDecrease)) {
      region.rejected();
      continue;
    }
    const bool done = std::abs(change) < kFunctionTolerance * at.cost;
    minimum.pose = candidate;
    region.accepted(change / predicted);
    if (done) break;
    at = problem.linearized(candidate);
  }
  return minimum;
}

}  // namespace aims::features
