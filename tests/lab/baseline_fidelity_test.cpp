// SPDX-License-Identifier: BSD-3-Clause
#include "lab/baselines/baseline_fidelity.hpp"

#include <gtest/gtest.h>

#include "bench/run/record.hpp"
#include "core/files/tum.hpp"
#include "tests/bench/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

bool go_on(const Progress&) { return true; }

/// Poses every 0.1 s along x at 1 m/s, from `start` [s] on.
Trajectory straight(double start, int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    trajectory.push_back({from_seconds(start + 0.1 * i), Pose()});
    trajectory.back().pose.translation.x() = 0.1 * i;
  }
  return trajectory;
}

TEST(PositionDifference, IgnoresTheFrameAndFindsADrift) {
  const Trajectory reference = straight(0.0, 11);
  const Pose T_other_reference{so3_exp({0.1, 0.2, 0.3}), {5.0, 6.0, 7.0}};
  Trajectory other = reference;
  for (StampedPose& each : other) each.pose = T_other_reference * each.pose;
  EXPECT_LT(position_difference(other, reference)->max, 1e-12);
  other.back().pose.translation.z() += 2.0;
  const auto difference = position_difference(other, reference);
  EXPECT_NEAR(difference->max, 2.0, 1e-12);
  EXPECT_NEAR(difference->rms, 2.0 / std::sqrt(11.0), 1e-12);
}

TEST(PositionDifference, TakesTheCommonStampsOnly) {
  EXPECT_LT(position_difference(straight(0.5, 3), straight(0.0, 20))->max, 1e-12);
  EXPECT_FALSE(position_difference(straight(100.0, 3), straight(0.0, 3)).has_value());
}

BaselineComparison comparison(bool published, bool native, double published_percent,
                              double native_percent) {
  BaselineComparison result;
  result.published.success = published;
  result.native.success = native;
  result.published.m_list_percent = published_percent;
  result.native.m_list_percent = native_percent;
  result.published.m_end = result.native.m_end = EndError{0.1, 0.1, 0.0};
  return result;
}

TEST(BaselineComparison, AgreesWithinTheLimitsOrWhenBothDiverge) {
  EXPECT_TRUE(comparison(true, true, 0.02, 0.06).agrees());
  EXPECT_FALSE(comparison(true, true, 0.02, 0.08).agrees());
  EXPECT_TRUE(comparison(true, true, 1.0, 1.29).agrees());
  EXPECT_FALSE(comparison(true, true, 1.0, 0.69).agrees());  // better is another system
  EXPECT_FALSE(comparison(true, false, 0.02, 0.02).agrees());
  EXPECT_FALSE(comparison(false, true, 50.0, 0.02).agrees());
  EXPECT_TRUE(comparison(false, false, 50.0, 20.0).agrees());
  BaselineComparison end = comparison(true, true, 0.02, 0.02);
  end.native.m_end = EndError{0.2, 0.2, 0.0};
  EXPECT_FALSE(end.agrees());
}

/// A recording, and what `leg` made of it as TUM files of IMU and LiDAR.
class BaselineFidelity : public ::testing::Test {
 protected:
  BaselineFidelity() {
    request_.options.bag = folder_.path() / "walk.bag";
    RecordOptions options;
    options.bag = request_.options.bag;
    EXPECT_TRUE(record(testing::short_walk(), options, go_on));
    request_.config.run = {"leg"};
    const auto result = estimate(request_.config, request_.options, go_on);
    EXPECT_TRUE(result.has_value());
    Trajectory poses = result->estimators.at(0).result.trajectory;
    EXPECT_TRUE(write_tum(folder_.path() / "imu.tum", poses));
    for (StampedPose& each : poses) each.pose = each.pose * result->setup.rig.T_body_lidar;
    EXPECT_TRUE(write_tum(folder_.path() / "lidar.tum", poses));
  }

  Result<std::vector<BaselineComparison>> compared(const char* reference) {
    request_.references = {folder_.path() / reference};
    return baseline_fidelity(request_, go_on);
  }

  TemporaryFolder folder_;
  BaselineFidelityRequest request_;
};

TEST_F(BaselineFidelity, OfASystemWithItselfIsPerfect) {
  for (const char* reference : {"imu.tum", "lidar.tum"}) {
    request_.body = reference[0] == 'l' ? ReferenceBody::kLidar : ReferenceBody::kImu;
    const auto comparisons = compared(reference);
    ASSERT_TRUE(comparisons) << comparisons.error().message;
    EXPECT_LT(comparisons->at(0).max_difference, 1e-9) << reference;
    EXPECT_TRUE(comparisons->at(0).agrees());
    EXPECT_NEAR(*comparisons->at(0).native.ate_m, *comparisons->at(0).published.ate_m, 1e-9);
    EXPECT_EQ(baseline_fidelity_table(*comparisons).rows.size(), 2U);
  }
  // Poses of the LiDAR taken for those of the IMU: the lever arm turns with the robot.
  request_.body = ReferenceBody::kImu;
  EXPECT_GT(compared("lidar.tum")->at(0).max_difference, 1e-5);
}

TEST_F(BaselineFidelity, WithoutAReferenceForEachEstimatorIsRefused) {
  request_.config.run = {"leg", "lio"};
  EXPECT_FALSE(compared("imu.tum").has_value());
  EXPECT_FALSE(compared("none.tum").has_value());
}

}  // namespace
}  // namespace aims
