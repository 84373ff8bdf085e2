// SPDX-License-Identifier: BSD-3-Clause
// The updates in the filter, in a synthetic corridor.
#include "estimator/aims/constrained_lio.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/estimator/aims/corridor_walk.hpp"

namespace aims {
namespace {

using E = ErrorState;

/// A prediction with an error of 3 cm along every axis.
Belief prediction(const Eigen::Vector3d& truth) {
  Belief belief;
  belief.state.position = truth + Eigen::Vector3d::Constant(0.03);
  belief.covariance = 1e-4 * ErrorMatrix::Identity();
  pose_block(belief.covariance).bottomRightCorner<3, 3>() *= 10.0;
  return belief;
}

struct Walk : test::CorridorWalk {
  Walk(bool pillars, std::unique_ptr<const ScanRule> rule) : CorridorWalk(pillars, "lio") {
    update = LidarUpdate(eskf_preset("lio"), std::move(rule));
  }
};

TEST(ConstrainedLio, XIcpStaysAsPredictedBetweenPlainWalls) {
  Walk walk(false, std::make_unique<XIcp>(XIcpConfig{.high_information = 100.0,
                                                     .enough_information = 100.0,
                                                     .insufficient_information = 50.0}));
  const Belief predicted = prediction(walk.truth);
  const Belief updated = walk.fuse(predicted);
  EXPECT_TRUE(walk.diagnostics.verdict.translation);
  EXPECT_GT(walk.diagnostics.iterations, 0);
  EXPECT_LT((updated.state.position - walk.truth).tail<2>().norm(), 0.01);
  EXPECT_NEAR(updated.state.position.x(), predicted.state.position.x(), 1e-3);
  const int x = E::kPosition.offset;
  EXPECT_NEAR(updated.covariance(x, x), predicted.covariance(x, x), 1e-5);
}

TEST(ConstrainedLio, XIcpCorrectsAlongTheWayWhereManyPillarsAre) {
  Walk walk(true, std::make_unique<XIcp>(XIcpConfig{.high_information = 60.0,
                                                    .enough_information = 60.0,
                                                    .insufficient_information = 30.0}));
  const Belief updated = walk.fuse(prediction(walk.truth));
  EXPECT_FALSE(walk.diagnostics.verdict.translation);
  EXPECT_LT((updated.state.position - walk.truth).norm(), 0.015);
}

// The plain update begins at a first guess, so that its planes are searched elsewhere.
TEST(ConstrainedLio, DcRegEndsWhereThePlainUpdateDoes) {
  for (const bool pillars : {false, true}) {
    Walk walk(pillars, std::make_unique<DcReg>(DcRegConfig{}));
    Walk plain(pillars, nullptr);
    const Belief predicted = prediction(walk.truth);
    const Belief updated = walk.fuse(predicted);
    const Belief expected = plain.fuse(predicted);
    EXPECT_LT((updated.state.position - expected.state.position).norm(), 3e-3) << pillars;
  }
}

// Until the legs are final, scans correct neither their scale nor their bias, whatever the rule.
TEST(ConstrainedLio, LegsThatAreHeldKeepTheirScaleUnderARule) {
  for (const bool held : {true, false}) {
    Walk walk(true, std::make_unique<DcReg>(DcRegConfig{}));
    walk.update.hold_legs(held);
    Belief predicted = prediction(walk.truth);
    const int scale = E::kLegScale.offset;
    const int x = E::kPosition.offset;
    predicted.covariance(scale, scale) = 0.01;
    predicted.covariance(scale, x) = predicted.covariance(x, scale) = 2e-3;
    const Belief updated = walk.fuse(predicted);
    EXPECT_EQ(updated.state.leg_scale.x() == 0.0, held);
    EXPECT_EQ(updated.covariance(scale, scale) == predicted.covariance(scale, scale), held);
  }
}

}  // namespace
}  // namespace aims
