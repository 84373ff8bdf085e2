// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/stance_forces.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/lie.hpp"

namespace aims {

namespace {

constexpr int kMaxForces = 3 * kLegCount;
/// Up to four forces stacked; no memory is allocated.
using Stack = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxForces, 1>;
using SquareStack =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxForces, kMaxForces>;
using ForceToAcceleration = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxForces>;

/// M^-1 A: what unit forces at the standing feet do to the trunk.
ForceToAcceleration force_to_acceleration(const StanceProblem& problem, int feet) {
  ForceToAcceleration B(6, 3 * feet);
  const Eigen::Matrix3d inverse_inertia = problem.inertia.inverse();
  int column = 0;
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (!problem.stands[leg]) continue;
    B.block<3, 3>(0, column) = Eigen::Matrix3d::Identity() / problem.mass;
    B.block<3, 3>(3, column) = inverse_inertia * hat(problem.lever[leg]);
    column += 3;
  }
  return B;
}

/// Projection of a force onto the friction cone and the normal force limits.
Eigen::Vector3d project(Eigen::Vector3d f, const StanceForceConfig& config) {
  const double mu = config.friction;
  const double tangential = f.head<2>().norm();
  if (tangential > mu * f.z()) {
    // Nearest point of the cone's surface: along the generatrix (mu, 1).
    const double along = std::max(0.0, (mu * tangential + f.z()) / (mu * mu + 1.0));
    if (tangential > 0.0) f.head<2>() *= mu * along / tangential;
    f.z() = along;
  }
  const double normal = std::clamp(f.z(), config.min_normal, config.max_normal);
  const double limit = mu * normal;
  const double left = f.head<2>().norm();
  if (left > limit) f.head<2>() *= limit / left;
  f.z() = normal;
  return f;
}

Stack project_stack(const Stack& forces, const StanceForceConfig& config) {
  Stack result(forces.size());
  for (Eigen::Index i = 0; i < forces.size(); i += 3) {
    result.segment<3>(i) = project(forces.segment<3>(i), config);
  }
  return result;
}

/// Alternating direction method of multipliers, started at the projected free minimum.
Stack minimize(const SquareStack& H, const Stack& gradient, const StanceForceConfig& config) {
  const Eigen::Index size = H.rows();
  const SquareStack identity = SquareStack::Identity(size, size);
  const Stack free_minimum = H.llt().solve(gradient);
  Stack feasible = project_stack(free_minimum, config);
  if (feasible == free_minimum) return feasible;
  const SquareStack inverse = (H + config.penalty * identity).llt().solve(identity);
  Stack multiplier = Stack::Zero(size);
  for (int i = 0; i < config.iterations; ++i) {
    const Stack forces = inverse * (gradient + config.penalty * (feasible - multiplier));
    feasible = project_stack(forces + multiplier, config);
    multiplier += forces - feasible;
  }
  return feasible;
}

}  // namespace

void describe(Fields& f, StanceForceConfig& c) {
  f.number("friction", c.friction,
           {.unit = "-",
            .range = positive_up_to(10.0),
            .meaning = "Friction coefficient of the cone that limits the contact forces."});
  f.number(
      "min_normal", c.min_normal,
      {.unit = "N", .range = up_to(1e5), .meaning = "Smallest normal force of a standing foot."});
  f.number(
      "max_normal", c.max_normal,
      {.unit = "N", .range = positive_up_to(1e5), .meaning = "Largest normal force of a foot."});
  f.number("regularization", c.regularization,
           {.unit = "1/kg^2",
            .range = positive_up_to(1e3),
            .meaning = "Weight of the squared forces against the acceleration error."});
  f.number("penalty", c.penalty,
           {.unit = "1/kg^2",
            .range = positive_up_to(1e3),
            .meaning = "Penalty of the splitting, of the order of one over the squared mass."});
  f.integer("iterations", c.iterations,
            {.unit = "-",
             .range = in_range(1, 1000),
             .meaning = "Iterations of the force distribution (ADMM)."});
}

std::array<Eigen::Vector3d, kLegCount> stance_forces(const StanceProblem& problem,
                                                     const StanceForceConfig& config) {
  std::array<Eigen::Vector3d, kLegCount> forces;
  forces.fill(Eigen::Vector3d::Zero());
  const int feet = static_cast<int>(std::count(problem.stands.begin(), problem.stands.end(), true));
  if (feet == 0) return forces;

  Eigen::Matrix<double, 6, 1> weight;
  weight << 1.0, 1.0, 1.0, 10.0, 10.0, 2.0;
  const ForceToAcceleration B = force_to_acceleration(problem, feet);
  const ForceToAcceleration weighted = weight.asDiagonal() * B;
  SquareStack H = B.transpose() * weighted;
  H.diagonal().array() += config.regularization;
  const Stack gradient = weighted.transpose() * problem.acceleration;

  const Stack solution = minimize(H, gradient, config);
  Eigen::Index row = 0;
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (!problem.stands[leg]) continue;
    forces[leg] = solution.segment<3>(row);
    row += 3;
  }
  return forces;
}

namespace {

constexpr double kTolerance = 0.01;  ///< of the feet's places, root mean square [m]

/// The feet about their mean, in the horizontal plane.
StanceHold::Offsets about_mean(const StanceHold::Feet& feet) {
  StanceHold::Offsets offsets;
  for (int leg = 0; leg < kLegCount; ++leg) offsets.col(leg) = feet[leg].head<2>();
  return offsets.colwise() - offsets.rowwise().mean().eval();
}

/// The turn that brings `from` closest to `to`.
Eigen::Matrix2d best_rotation(const StanceHold::Offsets& from, const StanceHold::Offsets& to) {
  const Eigen::Matrix2d products = to * from.transpose();
  const double angle = std::atan2(products(1, 0) - products(0, 1), products.trace());
  return Eigen::Rotation2Dd(angle).toRotationMatrix();
}

}  // namespace

void describe(Fields& f, StanceHoldConfig& c) {
  f.number("stiffness", c.stiffness,
           {.unit = "N/m",
            .range = up_to(1e6),
            .meaning = "Force per distance of a standing robot's foot from its place."});
  f.number("max_force", c.max_force,
           {.unit = "N", .range = up_to(1e4), .meaning = "Largest such force on a foot."});
}

void StanceHold::begin(const Feet& feet) { places_ = about_mean(feet); }

StanceHold::Offsets StanceHold::forces(const Feet& feet) const {
  const Offsets offsets = about_mean(feet);
  const Offsets moved = offsets - best_rotation(places_, offsets) * places_;
  const double distance = std::sqrt(moved.squaredNorm() / kLegCount);
  if (distance <= kTolerance) return Offsets::Zero();
  // A foot creeps along the force that it exerts, which is opposite to that of the ground.
  const double force = std::min(config_.stiffness * (distance - kTolerance), config_.max_force);
  return force / distance * moved;
}

}  // namespace aims
