// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/alignment.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

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

TEST(Alignment, OfErrorsOnTheWayIsThatOfACopy) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < 50; ++i) {
    const double t = 0.1 * i;
    pairs.push_back({i,
                     {so3_exp({0.1 * t, 0.2, t}), {t, std::sin(t), 0.3}},
                     {so3_exp({0.0, 0.1 * t, 1.1 * t}), {std::cos(t), t, 0.1 * t}}});
  }
  for (const Alignment& alignment : {align_yaw(pairs), align_se3(pairs), align_sim3(pairs)}) {
    const auto moved = aligned(pairs, alignment);
    EXPECT_EQ(ate_rmse(pairs, alignment), ate_rmse(moved));
    EXPECT_EQ(heading_rmse(pairs, alignment), heading_rmse(moved));
    EXPECT_EQ(position_errors(pairs, alignment), position_errors(moved));
    EXPECT_EQ(absolute_error_statistics(pairs, alignment)->std_m,
              absolute_error_statistics(moved)->std_m);
  }
}

TEST(ValidPart, IsTheTrajectoryItselfWhereAllPosesAreValid) {
  Trajectory poses = {{1, Pose()}, {2, Pose()}, {3, Pose()}};
  EXPECT_EQ(&ValidPart(poses).poses(), &poses);
  poses[1].stamp = 1;
  EXPECT_EQ(ValidPart(poses).poses().size(), 2U);
  poses[2].pose.translation.x() = std::nan("");
  EXPECT_EQ(ValidPart(poses).poses().size(), 1U);
}

TEST(AlignSe3, RecoversTheTransformExactly) {
  const Pose T = {so3_exp({0.4, -1.1, 2.0}), {10.0, -7.0, 3.0}};
  const Alignment alignment = align_se3(cloud(T, 0.0, 1));
  EXPECT_EQ(alignment.kind, AlignmentKind::kSe3);
  EXPECT_EQ(alignment.spread, PositionSpread::kFull);
  EXPECT_LT(distance(alignment.T_truth_estimate, T.inverse()), 1e-12);
}

TEST(AlignSe3, IsNeverWorseThanNearbyTransforms) {
  const auto pairs = cloud({so3_exp({0.1, 0.2, 0.3}), {1.0, 2.0, 3.0}}, 0.3, 2);
  Alignment alignment = align_se3(pairs);
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
  const Alignment alignment = align_se3(pairs);
  EXPECT_NEAR(alignment.T_truth_estimate.R().determinant(), 1.0, 1e-12);
}

/// A straight walk along x with a level body, the estimates moved by `T_estimate_truth`.
std::vector<PosePair> line(const Pose& T_estimate_truth) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < 100; ++i) {
    const Pose truth = {Eigen::Quaterniond::Identity(), {0.5 * i, 0.0, 0.0}};
    pairs.push_back({i * kSecond, T_estimate_truth * truth, truth});
  }
  return pairs;
}

TEST(AlignSe3, OfAStraightPathKeepsBothObservableAngles) {
  // Each turns positions and attitudes alike, so that the start tells the third angle.
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0.0, 0.0, 1.0), Eigen::Vector3d(0.0, 0.1, 0.0),
        Eigen::Vector3d(0.2, -0.1, 2.5)}) {
    const Pose T = {so3_exp(turn), {1.0, 2.0, 3.0}};
    std::vector<PosePair> pairs = line(T);
    // Exactly rank one: the truth has no other axis.
    const Alignment alignment = align_se3(pairs);
    EXPECT_LT(*ate_rmse(aligned(pairs, alignment)), 1e-12);
    if (alignment.spread == PositionSpread::kLine) {
      EXPECT_LT(distance(alignment.T_truth_estimate, T.inverse()), 1e-12);
    }
  }
  EXPECT_EQ(align_se3(line(Pose())).spread, PositionSpread::kLine);
}

TEST(AlignSe3, OfAnEstimateThatTurnsBackTakesItsLineAsItIs) {
  std::vector<PosePair> pairs = line(Pose());
  for (PosePair& each : pairs) each.estimate.translation *= -1.0;
  EXPECT_LT(*ate_rmse(aligned(pairs, align_se3(pairs))), 1e-12);
}

TEST(AlignSe3, IsNeverWorseThanAnyOtherAlignment) {
  RandomStream random = rng(9, "alignment_test");
  for (int trial = 0; trial < 500; ++trial) {
    // From clouds over planes and lines with sway to exact lines and points.
    const Eigen::Vector3d spread(trial % 5 == 0 ? 0.0 : 40.0 * random.uniform(),
                                 trial % 3 == 0 ? 0.0 : std::pow(10.0, -8.0 * random.uniform()),
                                 trial % 2 == 0 ? 0.0 : std::pow(10.0, -8.0 * random.uniform()));
    const Pose T = {so3_exp(random.normal3()), random.normal3()};
    std::vector<PosePair> pairs;
    for (int i = 0; i < 1 + trial % 40; ++i) {
      const Pose truth = {so3_exp(random.normal3()), spread.cwiseProduct(random.normal3())};
      Pose estimate = T * truth;
      estimate.translation += (trial % 7 == 0 ? 0.0 : 0.1) * random.normal3();
      pairs.push_back({i * kSecond, estimate, truth});
    }
    const double best = *ate_rmse(aligned(pairs, align_se3(pairs)));
    // Rounding leaves 2e-16 of the largest singular value, up to 1e4 m^2: a micrometre.
    EXPECT_LE(best, *ate_rmse(aligned(pairs, align_yaw(pairs))) + 1e-6) << trial;
    for (const AlignmentKind kind : {AlignmentKind::kStartPose, AlignmentKind::kStartHeading}) {
      EXPECT_LE(best, *ate_rmse(aligned(pairs, align_start(pairs, kind))) + 1e-6) << trial;
    }
  }
}

TEST(AlignSe3, OfOnePlaceOrNoPairsTakesTheStart) {
  const Pose T = {so3_exp({0.4, -1.1, 2.0}), {10.0, -7.0, 3.0}};
  auto pairs = cloud(T, 0.0, 5);
  pairs.resize(1);
  const Alignment alignment = align_se3(pairs);
  EXPECT_EQ(alignment.spread, PositionSpread::kPoint);
  EXPECT_LT(distance(alignment.T_truth_estimate, T.inverse()), 1e-12);
  EXPECT_EQ(align_se3({}).spread, PositionSpread::kPoint);
}

TEST(AlignYaw, RecoversHeadingAndTranslation) {
  const Pose T = {yaw_rotation(-2.5), {10.0, -7.0, 3.0}};
  const Alignment alignment = align_yaw(cloud(T, 0.0, 6));
  EXPECT_EQ(alignment.spread, PositionSpread::kFull);
  EXPECT_LT(distance(alignment.T_truth_estimate, T.inverse()), 1e-12);
}

TEST(AlignYaw, LeavesATiltAsError) {
  const Pose T = {so3_exp({0.1, 0.0, 0.0}), Eigen::Vector3d::Zero()};
  const auto pairs = cloud(T, 0.0, 7);
  EXPECT_GT(*ate_rmse(aligned(pairs, align_yaw(pairs))), 0.1);
  EXPECT_LT(*ate_rmse(aligned(pairs, align_se3(pairs))), 1e-12);
}

TEST(AlignStart, MakesTheFirstPoseEqualToItsTruth) {
  const auto pairs = cloud({so3_exp({0.4, -1.1, 2.0}), {10.0, -7.0, 3.0}}, 0.5, 8);
  const auto moved = aligned(pairs, align_start(pairs));
  EXPECT_LT(distance(moved[0].estimate, moved[0].truth), 1e-12);
}

/// Three seconds of standing at 10 Hz, then 20 m along x at 1 m/s.
std::vector<PosePair> stand_and_walk() {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 230; ++i) {
    const Pose truth = {Eigen::Quaterniond::Identity(), {std::max(0.0, 0.1 * i - 3.0), 0.0, 0.3}};
    pairs.push_back({i * 100 * kMillisecond, truth, truth});
  }
  return pairs;
}

TEST(AlignStart, ByPoseIsNotHeldToAnAttitudeThatWasLevelledWhileStanding) {
  auto pairs = stand_and_walk();
  for (std::size_t i = 0; i < 15; ++i) {
    pairs[i].estimate.rotation = so3_exp({0.0, 0.05 * (1.0 - static_cast<double>(i) / 15.0), 0.0});
  }
  const auto moved = aligned(pairs, align_start(pairs, AlignmentKind::kStartPose));
  EXPECT_LT(*max_abs_z_error(moved), 1e-12) << "by the first pose alone it is 1 m";
}

TEST(AlignStart, ByPoseAveragesTheNoiseOfTheStart) {
  RandomStream random = rng(12, "alignment_test");
  auto pairs = stand_and_walk();
  for (PosePair& each : pairs) {
    each.estimate = each.estimate * Pose{so3_exp(0.01 * random.normal3()), 0.01 * random.normal3()};
  }
  const Alignment alignment = align_start(pairs, AlignmentKind::kStartPose);
  // 16 poses: a quarter of the noise of one, here within three of its standard deviations.
  EXPECT_LT(so3_log(alignment.T_truth_estimate.rotation).norm(), 3.0 * 0.01 / 4.0 * std::sqrt(3.0));
}

TEST(AlignStart, TheStandingStartEndsWithTheFirstStepAndAfterTenSeconds) {
  const auto pairs = stand_and_walk();
  EXPECT_EQ(standing_start(pairs).size(), 31U) << "0.1 m away is no longer standing";
  const auto walking = std::span(pairs).subspan(31);
  EXPECT_EQ(standing_start(walking).size(), 1U);
  std::vector<PosePair> standing(300);
  for (std::size_t i = 0; i < standing.size(); ++i) {
    standing[i].stamp = static_cast<Time>(i) * 100 * kMillisecond;
  }
  EXPECT_EQ(standing_start(standing).size(), 101U);
  auto turning = standing;
  for (std::size_t i = 20; i < turning.size(); ++i) turning[i].truth.rotation = yaw_rotation(0.1);
  EXPECT_EQ(standing_start(turning).size(), 20U);
}

TEST(AlignStart, ByHeadingKeepsTheTilt) {
  std::vector<PosePair> pairs = {{0, {so3_exp({0.1, 0.0, 0.0}), {1.0, 2.0, 3.0}}, Pose()}};
  const auto moved = aligned(pairs, align_start(pairs, AlignmentKind::kStartHeading));
  EXPECT_LT(moved[0].estimate.translation.norm(), 1e-12);
  EXPECT_NEAR(yaw_of(moved[0].estimate.rotation), 0.0, 1e-12);
  EXPECT_NEAR(so3_log(moved[0].estimate.rotation).norm(), 0.1, 1e-12);
}

TEST(AlignSim3, IsEigensOfPointsInSpace) {
  RandomStream random = rng(11, "test.sim3");
  std::vector<PosePair> pairs;
  Eigen::Matrix3Xd from(3, 40);
  Eigen::Matrix3Xd to(3, 40);
  for (int i = 0; i < 40; ++i) {
    from.col(i) = 10.0 * random.normal3();
    to.col(i) = 1.7 * (so3_exp({0.3, -0.2, 2.0}) * from.col(i)) + Eigen::Vector3d(4, 5, 6) +
                0.3 * random.normal3();
    pairs.push_back({i * kSecond,
                     {Eigen::Quaterniond::Identity(), from.col(i)},
                     {Eigen::Quaterniond::Identity(), to.col(i)}});
  }
  const Eigen::Matrix4d expected = Eigen::umeyama(from, to, true);
  const Alignment alignment = align_sim3(pairs);
  const Eigen::Matrix3d scaled =
      alignment.scale * alignment.T_truth_estimate.rotation.toRotationMatrix();
  EXPECT_LT((scaled - expected.topLeftCorner<3, 3>()).norm(), 1e-9);
  EXPECT_LT((alignment.T_truth_estimate.translation - expected.topRightCorner<3, 1>()).norm(),
            1e-9);
  const std::vector<PosePair> moved = aligned(pairs, alignment);
  EXPECT_LT(
      (moved[3].estimate.translation - (expected * from.col(3).homogeneous()).head<3>()).norm(),
      1e-9);
}

}  // namespace
}  // namespace aims
