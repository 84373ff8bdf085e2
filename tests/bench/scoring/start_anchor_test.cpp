// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/start_anchor.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

/// Ten metres along a line at that heading [rad], from 1 m ahead of the origin, in ten seconds.
Trajectory line_at(double heading) {
  Trajectory line;
  for (int i = 0; i <= 100; ++i) {
    const Eigen::Vector3d along = yaw_rotation(heading) * Eigen::Vector3d(0.1 * i, 0.0, 0.0);
    line.push_back(
        {i * kSecond / 10, {yaw_rotation(heading), Eigen::Vector3d(1.0, 0.0, 0.0) + along}});
  }
  return line;
}

TEST(HeadingFitted, TurnsAnEstimateAboutItsFirstPoseOntoTheTruth) {
  const Trajectory truth = line_at(0.0);
  const Trajectory fitted = heading_fitted(line_at(0.02), truth, ScoreConfig(), std::nullopt);
  ASSERT_EQ(fitted.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR((fitted[i].pose.translation - truth[i].pose.translation).norm(), 0.0, 1e-9) << i;
  }
  EXPECT_NEAR(yaw_of(fitted.back().pose.rotation), 0.0, 1e-9);
}

TEST(HeadingFitted, WhatComesAfterAFailureDecidesNothing) {
  const Trajectory truth = line_at(0.0);
  Trajectory estimate = line_at(0.02);
  for (std::size_t i = 51; i < estimate.size(); ++i) estimate[i].pose.translation.y() -= 30.0;
  const Trajectory fitted = heading_fitted(estimate, truth, ScoreConfig(), 5 * kSecond);
  EXPECT_NEAR((fitted[50].pose.translation - truth[50].pose.translation).norm(), 0.0, 1e-9);
}

TEST(HeadingFitted, StaysWhereNothingIsCompared) {
  const Trajectory estimate = line_at(0.02);
  const Trajectory fitted = heading_fitted(estimate, {}, ScoreConfig(), std::nullopt);
  EXPECT_EQ(fitted.back().pose.translation, estimate.back().pose.translation);
}

}  // namespace
}  // namespace aims
