// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/config.hpp"
#include "core/measurements.hpp"

namespace aims {

/// Distribution of the contact forces over the standing feet.
struct StanceForceConfig {
  double friction = 0.35;        ///< friction coefficient of the force cone [-]
  double min_normal = 5.0;       ///< normal force of a standing foot [N]
  double max_normal = 160.0;     ///< [N]
  double regularization = 1e-4;  ///< weight of |f|^2 against accelerations [1/kg^2]
  double penalty = 0.02;         ///< of the splitting, of the order of 1/m^2 [1/kg^2]
  int iterations = 25;           ///< of the alternating direction method of multipliers (ADMM)
};
void describe(Fields& f, StanceForceConfig& c);

/// The trunk's centroidal dynamics at an instant, in one set of horizontal-plane axes (z up).
struct StanceProblem {
  double mass = 0.0;                                      ///< [kg]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< about the centre of mass [kg m^2]
  std::array<Eigen::Vector3d, kLegCount> lever{};         ///< centre of mass to foot [m]
  std::array<bool, kLegCount> stands{};
  /// Desired acceleration with gravity added: linear [m/s^2], angular [rad/s^2].
  Eigen::Matrix<double, 6, 1> acceleration = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Forces of the ground on the feet [N], zero where a foot does not stand: they minimize
/// |M^-1 A f - a|^2_W + regularization |f|^2 within friction cones and normal limits.
std::array<Eigen::Vector3d, kLegCount> stance_forces(const StanceProblem& problem,
                                                     const StanceForceConfig& config);

}  // namespace aims
