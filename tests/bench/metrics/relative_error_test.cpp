// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/relative_error.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/bench/metrics/trajectories.hpp"

namespace aims {
namespace {

std::vector<Eigen::Vector3d> line(int count, double step) {
  std::vector<Eigen::Vector3d> positions;
  for (int i = 0; i < count; ++i) positions.emplace_back(i * step, 0.0, 0.0);
  return positions;
}

TEST(PairsOverPath, ConsecutivePairsLeaveOutTheFirst) {
  const auto pairs = pairs_over_path(line(9, 0.5), {.delta = 1.0});
  const std::vector<std::pair<std::size_t, std::size_t>> expected = {{2, 4}, {4, 6}, {6, 8}};
  EXPECT_EQ(pairs, expected);
}

TEST(PairsOverPath, AllPairsAgreeWithBruteForce) {
  RandomStream random = rng(1, "relative_error_test");
  std::vector<Eigen::Vector3d> positions = {Eigen::Vector3d::Zero()};
  for (int i = 0; i < 300; ++i) {
    // Standing still now and then, so that several poses are equally far.
    const double step = random.chance(0.2) ? 0.0 : 0.1;
    positions.push_back(positions.back() + step * random.normal3());
  }
  std::vector<double> path = {0.0};
  for (std::size_t i = 1; i < positions.size(); ++i) {
    path.push_back(path.back() + (positions[i] - positions[i - 1]).norm());
  }
  std::vector<std::pair<std::size_t, std::size_t>> expected;
  for (std::size_t i = 0; i + 1 < positions.size(); ++i) {
    std::size_t best = i + 1;
    for (std::size_t j = i + 1; j < positions.size(); ++j) {
      if (std::abs(path[j] - path[i] - 1.0) < std::abs(path[best] - path[i] - 1.0)) best = j;
    }
    if (std::abs(path[best] - path[i] - 1.0) <= 0.1) expected.emplace_back(i, best);
  }
  EXPECT_EQ(pairs_over_path(positions, {.delta = 1.0, .all_pairs = true}), expected);
}

TEST(PairsOverPath, OfTooShortAPathAreNone) {
  for (const bool all : {false, true}) {
    EXPECT_TRUE(pairs_over_path(line(3, 0.1), {.delta = 1.0, .all_pairs = all}).empty());
    EXPECT_TRUE(pairs_over_path({}, {.delta = 1.0, .all_pairs = all}).empty());
  }
}

/// Pairs of a straight walk of 30 m, the estimate scaled and turning by `yaw_rate` per metre.
std::vector<PosePair> walk(double scale, double yaw_rate) {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 300; ++i) {
    const double x = 0.1 * i;
    pairs.push_back({i * kSecond,
                     {yaw_rotation(yaw_rate * x), {scale * x, 0.0, 0.0}},
                     {Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}}});
  }
  return pairs;
}

TEST(RelativePoseError, OfAScaleErrorIsTheScaleTimesThePath) {
  const RpeScore score = relative_pose_error(walk(1.02, 0.0), {.delta = 9.95});
  EXPECT_EQ(score.pairs, 2);
  EXPECT_NEAR(*score.translation_rmse_m, 0.02 * 10.0, 1e-9);
  EXPECT_NEAR(*score.rotation_rmse_rad, 0.0, 1e-9);
}

TEST(RelativePoseError, OfAHeadingDriftIsTheRateTimesThePath) {
  const RpeScore score = relative_pose_error(walk(1.0, 0.01), {.delta = 0.95});
  EXPECT_NEAR(*score.rotation_rmse_rad, 0.01, 1e-9);
}

TEST(RelativePoseError, DoesNotDependOnTheFrame) {
  auto pairs = walk(1.02, 0.01);
  const RpeScore before = relative_pose_error(pairs, {.delta = 0.95});
  const Pose T = {so3_exp({0.3, 0.2, 0.1}), {5.0, 6.0, 7.0}};
  for (PosePair& each : pairs) each.estimate = T * each.estimate;
  const RpeScore after = relative_pose_error(pairs, {.delta = 0.95});
  EXPECT_NEAR(*before.translation_rmse_m, *after.translation_rmse_m, 1e-12);
  EXPECT_NEAR(*before.rotation_rmse_rad, *after.rotation_rmse_rad, 1e-12);
}

TEST(RelativePoseError, OfNothingHasNoValue) {
  const RpeScore score = relative_pose_error({}, {.delta = 1.0});
  EXPECT_EQ(score.pairs, 0);
  EXPECT_FALSE(score.translation_rmse_m);
  EXPECT_FALSE(score.rotation_rmse_rad);
}

}  // namespace
}  // namespace aims
