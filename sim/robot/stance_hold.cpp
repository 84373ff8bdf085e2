// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/stance_hold.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace aims {
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
