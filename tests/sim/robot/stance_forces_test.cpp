// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/stance_forces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/random.hpp"

namespace aims {
namespace {

StanceProblem standing_robot() {
  StanceProblem problem;
  problem.mass = 12.6;
  problem.inertia = Eigen::Vector3d(0.16, 0.41, 0.43).asDiagonal();
  problem.lever = {
      {{0.19, 0.14, -0.28}, {0.19, -0.14, -0.28}, {-0.19, 0.14, -0.28}, {-0.19, -0.14, -0.28}}};
  problem.stands.fill(true);
  problem.acceleration << 0.0, 0.0, 9.81, 0.0, 0.0, 0.0;
  return problem;
}

Eigen::Matrix<double, 6, 1> resulting_acceleration(
    const StanceProblem& problem, const std::array<Eigen::Vector3d, kLegCount>& forces) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int leg = 0; leg < kLegCount; ++leg) {
    force += forces[leg];
    moment += problem.lever[leg].cross(forces[leg]);
  }
  Eigen::Matrix<double, 6, 1> acceleration;
  acceleration << force / problem.mass, problem.inertia.inverse() * moment;
  return acceleration;
}

TEST(StanceForces, CarryTheWeightWhenStandingStill) {
  const StanceProblem problem = standing_robot();
  const auto acceleration = resulting_acceleration(problem, stance_forces(problem, {}));
  EXPECT_NEAR(acceleration[2], 9.81, 0.05);
  EXPECT_LT((acceleration - problem.acceleration).norm(), 0.06);
}

TEST(StanceForces, GiveTheDesiredAccelerationInsideTheCone) {
  StanceProblem problem = standing_robot();
  problem.acceleration << 0.8, -0.4, 10.5, 1.0, -0.5, 0.8;
  const auto acceleration = resulting_acceleration(problem, stance_forces(problem, {}));
  EXPECT_LT((acceleration - problem.acceleration).norm(), 0.1);
}

TEST(StanceForces, RespectConesAndLimitsForAnyAcceleration) {
  RandomStream random(3, "test");
  const StanceForceConfig config;
  for (int trial = 0; trial < 300; ++trial) {
    StanceProblem problem = standing_robot();
    problem.acceleration << 20.0 * random.normal3(), 60.0 * random.normal3();
    for (bool& stands : problem.stands) stands = random.chance(0.7);
    const auto forces = stance_forces(problem, config);
    for (int leg = 0; leg < kLegCount; ++leg) {
      const Eigen::Vector3d& f = forces[leg];
      if (!problem.stands[leg]) {
        EXPECT_TRUE(f.isZero());
        continue;
      }
      EXPECT_LE(f.head<2>().norm(), config.friction * f.z() * (1.0 + 1e-9)) << "trial " << trial;
      EXPECT_GE(f.z(), config.min_normal - 1e-9) << "trial " << trial;
      EXPECT_LE(f.z(), config.max_normal + 1e-9) << "trial " << trial;
    }
  }
}

TEST(StanceForces, LeaveTheFeetAloneWhenNoneStands) {
  StanceProblem problem = standing_robot();
  problem.stands.fill(false);
  for (const Eigen::Vector3d& f : stance_forces(problem, {})) EXPECT_TRUE(f.isZero());
}

}  // namespace
}  // namespace aims
