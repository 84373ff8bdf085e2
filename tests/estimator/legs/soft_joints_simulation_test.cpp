// SPDX-License-Identifier: BSD-3-Clause
// What estimators say of a simulated robot on soft joints.
#include <gtest/gtest.h>

#include <algorithm>

#include "estimator/registry.hpp"
#include "tests/estimator/simulated_sequence.hpp"

namespace aims {
namespace {

constexpr double kWay = 10.0;  // [m]

/// What `leg_inertial` says over a straight way on joints of that stiffness [N m/rad].
std::vector<HealthRow> health_on(double joint_stiffness) {
  SimulationConfig config = testing::straight_sequence(kWay, 16);
  config.leg_odometry.foot_model = FootModel::kRolling;
  config.leg_odometry.joint_stiffness = joint_stiffness;
  const testing::SimulatedSequence sequence = testing::simulate(config, 1);
  const auto estimator = make_estimator("leg_inertial", sequence.rig).value();
  for (const Delivery& delivery : sequence.deliveries) estimator->consume(delivery);
  estimator->finish();
  return estimator->result().health;
}

bool names_soft_joints(const HealthRow& row) {
  return std::ranges::find(row.reasons, "soft joints make the distance uncertain") !=
         row.reasons.end();
}

TEST(SoftJointsSimulation, DegradeTheHealthAndWidenTheStatedPosition) {
  const std::vector<HealthRow> soft = health_on(90.0);
  EXPECT_TRUE(names_soft_joints(soft.back()));
  EXPECT_EQ(soft.back().state, HealthState::kDegraded);
  const std::vector<HealthRow> stiff = health_on(2000.0);
  EXPECT_TRUE(std::ranges::none_of(stiff, names_soft_joints));
  EXPECT_GT(soft.back().position_sigma, 1.3 * stiff.back().position_sigma);
  EXPECT_GT(soft.back().position_sigma, 0.06 * kWay);
}

}  // namespace
}  // namespace aims
