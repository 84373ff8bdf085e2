// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/constrained/x_icp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/estimator/constrained/synthetic_scans.hpp"

namespace aims {
namespace {

using test::add_end_wall;
using test::add_face;
using test::Correspondences;
using test::corridor;
using test::measurement_of;
using test::room;

constexpr int kMany = 1000;  // points of a face

int count(const std::array<LocalizedDirection, 6>& all, LocalizabilityCategory category) {
  return static_cast<int>(std::ranges::count(all, category, &LocalizedDirection::category));
}

TEST(XIcp, APlainCorridorIsFreeAlongItselfOnly) {
  RandomStream random(1, "x_icp.test");
  const auto all = localizability(corridor(kMany, random), {});
  EXPECT_EQ(count(all, LocalizabilityCategory::kNone), 1);
  EXPECT_EQ(count(all, LocalizabilityCategory::kPartial), 0);
  EXPECT_EQ(all[3].category, LocalizabilityCategory::kNone);
  EXPECT_NEAR(std::abs(all[3].direction(3)), 1.0, 1e-9);
  EXPECT_NEAR(all[3].combined, 0.0, 1e-9);
}

TEST(XIcp, ARoomIsFreeNowhere) {
  RandomStream random(2, "x_icp.test");
  EXPECT_EQ(count(localizability(room(kMany, random), {}), LocalizabilityCategory::kFull), 6);
}

TEST(XIcp, AFloorLeavesThreeDirections) {
  RandomStream random(3, "x_icp.test");
  Correspondences floor;
  add_face(floor, 3 * kMany, {0.0, 0.0, -0.5}, {8.0, 0.0, 0.0}, {0.0, 8.0, 0.0},
           Eigen::Vector3d::UnitZ(), random);
  const auto all = localizability(floor, {});
  EXPECT_EQ(count(all, LocalizabilityCategory::kNone), 3);
  EXPECT_EQ(all[0].category, LocalizabilityCategory::kNone);
  EXPECT_NEAR(std::abs(all[0].direction(2)), 1.0, 1e-9) << "yaw";
  EXPECT_EQ(all[5].category, LocalizabilityCategory::kFull) << "height";
}

TEST(XIcp, ATunnelIsFreeAlongAndAboutItsAxis) {
  RandomStream random(4, "x_icp.test");
  Correspondences tunnel;
  for (int i = 0; i < 2000; ++i) {
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Eigen::Vector3d n(0.0, std::cos(angle), std::sin(angle));
    tunnel.push_back({2.0 * n + random.uniform(-9.0, 9.0) * Eigen::Vector3d::UnitX(), n, n, 0.0});
  }
  const auto all = localizability(tunnel, {});
  EXPECT_EQ(count(all, LocalizabilityCategory::kNone), 2);
  EXPECT_NEAR(std::abs(all[0].direction(0)), 1.0, 1e-3);
  EXPECT_NEAR(std::abs(all[3].direction(3)), 1.0, 1e-3);
}

// Normals that err by less than 10 degrees add nothing, however many they are.
TEST(XIcp, NoiseOfNormalsDoesNotContribute) {
  RandomStream random(5, "x_icp.test");
  Correspondences scan = corridor(10 * kMany, random);
  for (Correspondence& each : scan) {
    each.normal =
        (each.normal + random.uniform(-0.15, 0.15) * Eigen::Vector3d::UnitX()).normalized();
    each.normal_in_body = each.normal;
  }
  EXPECT_EQ(localizability(scan, {})[3].category, LocalizabilityCategory::kNone);
  EXPECT_EQ(localizability(scan, {.minimal_angle_deg = 90.0})[3].category,
            LocalizabilityCategory::kFull);
}

TEST(XIcp, CategoriesFollowTheSumOfContributions) {
  RandomStream random(6, "x_icp.test");
  for (const auto& [points, expected] : {std::pair{149, LocalizabilityCategory::kNone},
                                         {151, LocalizabilityCategory::kPartial},
                                         {299, LocalizabilityCategory::kPartial},
                                         {301, LocalizabilityCategory::kFull}}) {
    Correspondences scan = corridor(kMany, random);
    add_end_wall(scan, points, random);
    const LocalizedDirection ahead = localizability(scan, {})[3];
    EXPECT_EQ(ahead.category, expected) << points;
    EXPECT_NEAR(ahead.combined, points, 1e-6);
    EXPECT_NEAR(ahead.strong, points, 1e-6);
  }
}

// Weak contributions, 60 degrees from the direction, count among all and not among the strong ones.
TEST(XIcp, StrongContributionsAreNearerThanFortyFiveDegrees) {
  RandomStream random(7, "x_icp.test");
  Correspondences scan = corridor(kMany, random);
  const Eigen::Vector3d oblique(0.5, std::sqrt(0.75), 0.0);
  add_face(scan, 100, {5.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 0.1, 0.0}, oblique, random);
  add_face(scan, 100, {5.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 0.1, 0.0},
           {oblique.x(), -oblique.y(), 0.0}, random);
  const LocalizedDirection ahead = localizability(scan, {})[3];
  EXPECT_NEAR(ahead.combined, 100.0, 0.5);
  EXPECT_NEAR(ahead.strong, 0.0, 1e-9);
}

TEST(XIcp, ResampledCorrespondencesAskForTheDisplacement) {
  RandomStream random(8, "x_icp.test");
  Vector6 error = Vector6::Zero();
  error(3) = 0.04;
  Correspondences scan = corridor(kMany, random);
  add_end_wall(scan, 200, random, error);
  const LocalizedDirection ahead = localizability(scan, {})[3];
  ASSERT_EQ(ahead.category, LocalizabilityCategory::kPartial);
  EXPECT_NEAR(ahead.sampled * ahead.direction(3), -0.04, 1e-9);
  Vector6 offset = Vector6::Zero();
  offset(3) = 0.1;
  const PoseConstraints constraints = constraints_of(localizability(scan, {}), offset);
  ASSERT_EQ(constraints.equal.size(), 1U);
  EXPECT_TRUE(constraints.equal[0].measured);
  EXPECT_NEAR(constraints.equal[0].value * ahead.direction(3), 0.06, 1e-9);
}

/// A scan of a corridor with the pose off by the same along every direction, and the noise of
/// normals that makes the way along it look measured.
Correspondences misleading_scan(RandomStream& random) {
  Correspondences scan = corridor(kMany, random, Vector6::Constant(0.01));
  for (Correspondence& each : scan) {
    each.normal = (each.normal + 0.05 * random.normal() * Eigen::Vector3d::UnitX()).normalized();
    each.normal_in_body = each.normal;
  }
  return scan;
}

TEST(XIcp, KeepsThePredictionAlongTheCorridorAndCorrectsTheRest) {
  RandomStream random(9, "x_icp.test");
  Belief prior;
  prior.covariance *= 0.01;
  const Correspondences scan = misleading_scan(random);
  const RuledUpdate update =
      XIcp({}).fuse(prior, prior.state, {measurement_of(scan, 0.01), {}}, scan);
  EXPECT_TRUE(update.verdict.translation);
  EXPECT_FALSE(update.verdict.rotation);
  EXPECT_FALSE(update.verdict.partial);
  const Vector6 along = localizability(scan, {})[3].direction;
  const ErrorVector moved = boxminus(update.belief.state, prior.state);
  EXPECT_NEAR(along.dot(pose_segment(moved)), 0.0, 1e-12);
  EXPECT_LT((moved.segment<2>(4) + Eigen::Vector2d::Constant(0.01)).norm(), 0.002);
  EXPECT_LT((moved.head<3>() + Eigen::Vector3d::Constant(0.01)).norm(), 0.002);
}

// l x = g becomes (l + w^2 / l) x = g along the direction.
TEST(XIcp, SoftConstraintsShrinkTheStep) {
  RandomStream random(10, "x_icp.test");
  Belief prior;
  prior.covariance *= 1e9;
  Correspondences scan = corridor(kMany, random);
  Vector6 error = Vector6::Zero();
  error(3) = 0.01;
  add_end_wall(scan, 100, random, error);
  add_face(scan, 100, {-10.0, 0.0, 0.0}, {0.0, 1.1, 0.0}, {0.0, 0.0, 1.2}, Eigen::Vector3d::UnitX(),
           random, error);
  XIcpConfig soft{.insufficient_information = 250.0, .soft_weight = 100.0};
  const LocalizedDirection ahead = localizability(scan, soft)[3];
  ASSERT_EQ(ahead.category, LocalizabilityCategory::kNone);
  const RuledUpdate update =
      XIcp(soft).fuse(prior, prior.state, {measurement_of(scan, 1.0), {}}, scan);
  const double ratio = ahead.eigenvalue / (ahead.eigenvalue + 1e4 / ahead.eigenvalue);
  EXPECT_NEAR(update.belief.state.position.x(), -0.01 * ratio, 1e-4);
  EXPECT_NEAR(ahead.eigenvalue, 200.0, 0.5);
}

}  // namespace
}  // namespace aims
