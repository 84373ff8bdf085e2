// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/alignment.hpp"

#include <gtest/gtest.h>

#include "bench/metrics/absolute_error.hpp"
#include "core/random.hpp"
#include "tests/bench/metrics/trajectories.hpp"

namespace aims {
namespace {

/// Pairs of a random cloud of poses, the estimates moved by `T_estimate_truth`.
std::vector<PosePair> cloud(const Pose& T_estimate_truth, double noise, std::uint64_t seed) {
  RandomStream random = rng(seed, "alignment_test");
  std::vector<PosePair> pairs;
  for (int i = 0; i < 50; ++i) {
    const Pose truth = {so3_exp(random.normal3()), 5.0 * random.normal3()};
    Pose estimate = T_estimate_truth * truth;
    estimate.translation += noise * random.normal3();
    pairs.push_back({i * kSecond, estimate, truth});
  }
  return pairs;
}

double distance(const Pose& a, const Pose& b) {
  const Pose difference = a.inverse() * b;
  return difference.translation.norm() + so3_log(difference.rotation).norm();
}

TEST(AlignSe3, RecoversTheTransformExactly) {
  const Pose T = {so3_exp({0.4, -1.1, 2.0}), {10.0, -7.0, 3.0}};
  const Alignment alignment = align_se3(cloud(T, 0.0, 1), 1e-6);
  EXPECT_EQ(alignment.kind, AlignmentKind::kSe3);
  EXPECT_FALSE(alignment.degenerate);
  EXPECT_LT(distance(alignment.T_truth_estimate, T.inverse()), 1e-12);
}

TEST(AlignSe3, IsNeverWorseThanNearbyTransforms) {
  const auto pairs = cloud({so3_exp({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}}, 0.3, 2);
  Alignment alignment = align_se3(pairs, 1e-6);
  const double best = *ate_rmse(aligned(pairs, alignment));
  const Pose found = alignment.T_truth_estimate;
  RandomStream random = rng(3, "alignment_test");
  for (int i = 0; i < 200; ++i) {
    const Pose nudge = {so3_exp(1e-3 * random.normal3()), 1e-2 * random.normal3()};
    alignment.T_truth_estimate = found * nudge;
    EXPECT_GE(*ate_rmse(aligned(pairs, alignment)), best);
  }
}

TEST(AlignSe3, NeverMirrors) {
  auto pairs = cloud(Pose(), 0.0, 4);
  for (PosePair& each : pairs) each.estimate.translation.z() *= -1.0;
  const Alignment alignment = align_se3(pairs, 1e-6);
  EXPECT_NEAR(alignment.T_truth_estimate.R().determinant(), 1.0, 1e-12);
}

TEST(AlignSe3, OfAStraightPathIsDegenerateAndTurnsAboutZOnly) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < 100; ++i) {
    const Pose truth = {Eigen::Quaterniond::Identity(), {i * 0.8, 0.01 * std::sin(i), 0.0}};
    pairs.push_back({i * kSecond, Pose{yaw_rotation(1.0), {1.0, 2.0, 3.0}} * truth, truth});
  }
  const Alignment alignment = align_se3(pairs, 1e-6);
  EXPECT_TRUE(alignment.degenerate);
  EXPECT_EQ(alignment.kind, AlignmentKind::kYaw);
  EXPECT_LT(*ate_rmse(aligned(pairs, alignment)), 1e-12);
}

TEST(AlignSe3, OfTwoPosesIsDegenerate) {
  auto pairs = cloud(Pose(), 0.0, 5);
  pairs.resize(2);
  EXPECT_TRUE(align_se3(pairs, 1e-6).degenerate);
  EXPECT_TRUE(align_se3({}, 1e-6).degenerate);
}

TEST(AlignYaw, RecoversHeadingAndTranslation) {
  const Pose T = {yaw_rotation(-2.5), {10.0, -7.0, 3.0}};
  const Alignment alignment = align_yaw(cloud(T, 0.0, 6));
  EXPECT_FALSE(alignment.degenerate);
  EXPECT_LT(distance(alignment.T_truth_estimate, T.inverse()), 1e-12);
}

TEST(AlignYaw, LeavesATiltAsError) {
  const Pose T = {so3_exp({0.1, 0.0, 0.0}), Eigen::Vector3d::Zero()};
  const auto pairs = cloud(T, 0.0, 7);
  EXPECT_GT(*ate_rmse(aligned(pairs, align_yaw(pairs))), 0.1);
  EXPECT_LT(*ate_rmse(aligned(pairs, align_se3(pairs, 1e-6))), 1e-12);
}

TEST(AlignStart, MakesTheFirstPoseEqualToItsTruth) {
  const auto pairs = cloud({so3_exp({0.4, -1.1, 2.0}), {10.0, -7.0, 3.0}}, 0.5, 8);
  const auto moved = aligned(pairs, align_start(pairs));
  EXPECT_LT(distance(moved[0].estimate, moved[0].truth), 1e-12);
}

TEST(AlignStart, ByHeadingKeepsTheTilt) {
  std::vector<PosePair> pairs = {{0, {so3_exp({0.1, 0.0, 0.0}), {1.0, 2.0, 3.0}}, Pose()}};
  const auto moved = aligned(pairs, align_start(pairs, AlignmentKind::kStartHeading));
  EXPECT_LT(moved[0].estimate.translation.norm(), 1e-12);
  EXPECT_NEAR(yaw_of(moved[0].estimate.rotation), 0.0, 1e-12);
  EXPECT_NEAR(so3_log(moved[0].estimate.rotation).norm(), 0.1, 1e-12);
}

}  // namespace
}  // namespace aims
