// SPDX-License-Identifier: BSD-3-Clause
// A trot in closed form, its joints in any order.
#include "recordings/legs/leg_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/recordings/legs/trot.hpp"

namespace aims {
namespace {

using test::Trot;

const LegGeometry kGeometry = test::kTrotGeometry;

/// The finder after 10 s of it, with the joint of entry i in `order[i]`, and feet in `feet`.
LegOrderFinder finder_of(const Trot& trot, const std::vector<int>& order,
                         const std::array<int, kLegCount>& feet = {0, 1, 2, 3}) {
  LegOrderFinder finder;
  for (int k = 0; k < 1000; ++k) {
    const double time = 0.01 * k + 0.003;
    const JointVector q = trot.angles(time);
    std::vector<double> angles;
    for (const int joint : order) angles.push_back(q[joint]);
    FootLoads loads{};
    const auto contact = trot.contact(time);
    for (std::size_t i = 0; i < loads.size(); ++i) {
      loads[i] = contact[static_cast<std::size_t>(feet[i])] ? 60.0 : 0.0;
    }
    finder.add_imu({0.0, 0.0, trot.rate});
    finder.add_loads(loads);
    finder.add_joints(k * 10 * kMillisecond, angles, {});
  }
  return finder;
}

/// The joints of each leg together, or all of one kind together.
std::vector<int> entries(const std::array<int, kLegCount>& legs, bool by_leg) {
  std::vector<int> order;
  for (int i = 0; i < kJointCount; ++i) {
    const int leg = legs[static_cast<std::size_t>(by_leg ? i / 3 : i % 4)];
    order.push_back(3 * leg + (by_leg ? i % 3 : i / 4));
  }
  return order;
}

TEST(LegOrder, IsFoundForEveryOrderOfTheLegsOfARobotThatTurns) {
  std::array<int, kLegCount> legs = {0, 1, 2, 3};
  do {
    for (const bool by_leg : {true, false}) {
      const std::vector<int> order = entries(legs, by_leg);
      const auto found = finder_of({.rate = 0.4}, order)
                             .find(kGeometry, Eigen::Quaterniond::Identity(), std::nullopt, true);
      ASSERT_TRUE(found) << found.error().message;
      for (std::size_t joint = 0; joint < found->joints.size(); ++joint) {
        EXPECT_EQ(order[found->joints[joint]], static_cast<int>(joint)) << found->text;
      }
    }
  } while (std::ranges::next_permutation(legs).found);
}

TEST(LegOrder, OrdersThatGiveTheSameVelocityAreNoError) {
  // Hip and knee of each leg, then the abductions; left legs first.
  const std::vector<int> order = {1, 2, 7, 8, 4, 5, 10, 11, 0, 6, 3, 9};
  const auto found =
      finder_of({}, order).find(kGeometry, Eigen::Quaterniond::Identity(), std::nullopt, true);
  ASSERT_TRUE(found) << found.error().message;
  for (std::size_t joint = 0; joint < found->joints.size(); ++joint) {
    EXPECT_EQ(order[found->joints[joint]] % 3, static_cast<int>(joint % 3));
  }
  EXPECT_NE(found->text.find("other orders give the same velocity"), std::string::npos);
}

TEST(LegOrder, KneesThatBendTheOtherWayAreAnError) {
  std::vector<int> order(kJointCount);
  std::iota(order.begin(), order.end(), 0);
  const auto found = finder_of({.knee_sign = -1.0}, order)
                         .find(kGeometry, Eigen::Quaterniond::Identity(), std::nullopt, true);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("four bent knees"), std::string::npos);
}

TEST(LegOrder, FeetWithoutNamesAreFoundByTheMotionOfTheLegs) {
  JointOrder known;
  std::iota(known.begin(), known.end(), 0);
  std::vector<int> order(kJointCount);
  std::iota(order.begin(), order.end(), 0);
  const auto found = finder_of({.rate = 0.4}, order, {1, 0, 3, 2})
                         .find(kGeometry, Eigen::Quaterniond::Identity(), known, false);
  ASSERT_TRUE(found) << found.error().message;
  // Feet that stand together cannot be told apart, and need not be.
  const auto pair = [](int leg) { return leg == 0 || leg == 3; };
  EXPECT_FALSE(pair(found->feet[0]));
  EXPECT_TRUE(pair(found->feet[1]));
}

}  // namespace
}  // namespace aims
