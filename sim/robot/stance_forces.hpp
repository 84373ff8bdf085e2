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

/// How strongly a standing robot keeps its feet apart.
struct StanceHoldConfig {
  double stiffness = 1000.0;  ///< beyond the tolerance [N/m]
  double max_force = 10.0;    ///< on a foot, root mean square [N]
};
void describe(Fields& f, StanceHoldConfig& c);

/// Keeps the feet of a standing robot apart as they were when it came to stand.
///
/// The forces that carry the trunk do not carry the legs: their weight pulls the feet inwards. On a
/// contact that gives way a little under any tangential force, as that of the simulation, the feet
/// then creep towards each other, by some 0.2 mm/s, until the stance is too narrow to stand on.
class StanceHold {
 public:
  using Feet = std::array<Eigen::Vector3d, kLegCount>;  ///< positions in the world [m]
  using Offsets = Eigen::Matrix<double, 2, kLegCount>;  ///< one column per foot, world axes

  explicit StanceHold(const StanceHoldConfig& config = {}) : config_(config) {}

  /// The feet stand where they are to stay.
  void begin(const Feet& feet);

  /// Horizontal forces of the ground on the feet [N] that return each foot to its place among the
  /// others. They have no sum and no moment: the trunk does not feel them. Zero while the feet are
  /// within a tolerance of their places, as in every short pause.
  Offsets forces(const Feet& feet) const;

 private:
  StanceHoldConfig config_;
  Offsets places_ = Offsets::Zero();  ///< of the feet about their mean [m]
};

}  // namespace aims
