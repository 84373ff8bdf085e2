// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/robot/robot_geometry.hpp"
#include "sim/robot/stance_forces.hpp"
#include "tests/support/walking.hpp"

namespace aims {
namespace {

/// Positions of the feet in the world [m].
StanceHold::Feet feet_of(const RobotState& state) {
  StanceHold::Feet feet;
  for (int leg = 0; leg < kLegCount; ++leg) {
    feet[leg] = state.T_world_base * foot_in_base(leg, joints_of(state.q, leg), kRobotGeometry);
  }
  return feet;
}

/// Largest change of the distance between two feet [m].
double largest_change(const StanceHold::Feet& before, const StanceHold::Feet& after) {
  double largest = 0.0;
  for (int a = 0; a < kLegCount; ++a) {
    for (int b = 0; b < a; ++b) {
      const double change = (after[a] - after[b]).norm() - (before[a] - before[b]).norm();
      largest = std::max(largest, std::abs(change));
    }
  }
  return largest;
}

double tilt_of(const RobotState& state) {
  return (state.T_world_base.rotation * Eigen::Vector3d::UnitZ()).head<2>().norm();
}

TEST(Standing, AnHourMovesNothingAndTheRobotWalksAfterwards) {
  RouteConfig route = testing::there_and_back(2.0);
  route.stand_before = 3600.0;
  Walker walker = Walker::create(testing::corridor_world(2.0, 0.8, 0.0), {}, route).value();
  walker.settle();
  const RobotState start = walker.world().state();
  while (walker.world().state().stamp < from_seconds(route.stand_before) && !walker.fallen()) {
    walker.step();
  }
  const RobotState end = walker.world().state();
  const Eigen::Vector3d moved = end.T_world_base.translation - start.T_world_base.translation;
  EXPECT_LT(moved.head<2>().norm(), 0.005);
  EXPECT_LT(std::abs(moved.z()), 0.005);
  EXPECT_LT(tilt_of(end), 0.03) << "it stands with its nose up by 1.3 degrees";
  EXPECT_LT(largest_change(feet_of(start), feet_of(end)), 0.03);
  while (!walker.route().done() && !walker.fallen() &&
         walker.world().state().stamp < from_seconds(route.stand_before + 60.0)) {
    walker.step();
  }
  EXPECT_TRUE(walker.route().done());
  EXPECT_FALSE(walker.fallen());
}

StanceHold::Feet square() {
  return {Eigen::Vector3d(0.2, 0.1, 0.0), Eigen::Vector3d(0.2, -0.1, 0.0),
          Eigen::Vector3d(-0.2, 0.1, 0.0), Eigen::Vector3d(-0.2, -0.1, 0.0)};
}

/// The feet turned by `angle` [rad] about a point and shifted: the same stance elsewhere.
StanceHold::Feet moved_stance(double angle) {
  StanceHold::Feet feet = square();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (Eigen::Vector3d& foot : feet) foot = turn * foot + Eigen::Vector3d(0.3, -0.2, 0.05);
  return feet;
}

TEST(StanceHold, LeavesAStanceAloneThatHasOnlyMovedAsAWhole) {
  StanceHold hold;
  hold.begin(square());
  for (const double angle : {0.0, 0.4, -2.5}) {
    StanceHold::Feet feet = moved_stance(angle);
    feet[0].x() += 0.01;  // within the tolerance
    EXPECT_EQ(hold.forces(feet).norm(), 0.0) << angle;
  }
}

TEST(StanceHold, PushesFeetApartThatCameTogetherAndNotTheTrunk) {
  StanceHold hold;
  hold.begin(square());
  StanceHold::Feet narrow = moved_stance(0.4);
  const Eigen::Vector2d middle(0.3, -0.2);
  for (Eigen::Vector3d& foot : narrow) foot.head<2>() = middle + 0.8 * (foot.head<2>() - middle);
  narrow[2].x() += 0.01;
  const StanceHold::Offsets forces = hold.forces(narrow);
  double moment = 0.0;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector2d arm = narrow[leg].head<2>() - middle;
    EXPECT_LT(forces.col(leg).dot(arm), 0.0) << "the ground holds against a foot that pushes out";
    moment += arm.x() * forces(1, leg) - arm.y() * forces(0, leg);
  }
  EXPECT_LT(forces.rowwise().sum().norm(), 1e-9);
  EXPECT_LT(std::abs(moment), 1e-9);
}

}  // namespace
}  // namespace aims
