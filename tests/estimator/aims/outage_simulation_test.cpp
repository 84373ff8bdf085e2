// SPDX-License-Identifier: BSD-3-Clause
// A simulated robot of which nothing is measured for a while, in a turn and on the way.
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "estimator/registry.hpp"
#include "tests/estimator/simulated_sequence.hpp"

namespace aims {
namespace {

using testing::SimulatedSequence;

class OutageSimulation : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    SimulationConfig config = testing::straight_sequence(8.0, 200);
    config.route.points = {{"a", 0.0, 0.0}, {"b", 5.0, 0.0}, {"a", 0.0, 0.0}};
    sequence_ = testing::simulate(config, 1);
  }

  /// When the robot first has turned by `angle` [rad].
  static Time turned_by(double angle) {
    return std::ranges::find_if(sequence_.truth.samples,
                                [&](const TruthSample& sample) {
                                  return std::abs(yaw_of(sample.T_world_body.rotation)) > angle;
                                })
        ->stamp;
  }

  /// What `estimator` makes of the sequence without what was measured within [begin, end), or, with
  /// `legs`, without IMU and LiDAR alone.
  static EstimatorResult without(const char* estimator, Time begin, Time end, bool legs = false) {
    const auto estimate = make_estimator(estimator, sequence_.rig).value();
    for (const Delivery& delivery : sequence_.deliveries) {
      const Time stamp = stamp_of(delivery.measurement);
      const bool kept = legs && std::holds_alternative<LegOdometrySample>(delivery.measurement);
      if (kept || stamp < begin || stamp >= end) estimate->consume(delivery);
    }
    estimate->finish();
    return estimate->result();
  }

  static Eigen::Vector3d end_of(const EstimatorResult& result) {
    return result.trajectory.back().pose.translation;
  }

  static bool names_lost_position(const EstimatorResult& result) {
    return std::ranges::find(result.health.back().reasons,
                             "position lost in an outage of the sensors") !=
           result.health.back().reasons.end();
  }

  inline static SimulatedSequence sequence_;
};

TEST_F(OutageSimulation, TheHeadingIsFoundAgainAfterAGapInATurn) {
  const Time turning = turned_by(0.4);
  for (const char* estimator : {"aims_d", "lio"}) {
    const EstimatorResult whole = without(estimator, 0, 0);
    EXPECT_FALSE(whole.counts.contains("lidar.heading_searched")) << estimator;
    for (const Duration gap : {kSecond, 3 * kSecond / 2}) {
      const EstimatorResult result = without(estimator, turning, turning + gap);
      EXPECT_EQ(result.counts.at("lidar.heading_searched"), 1) << estimator;
      EXPECT_LT((end_of(result) - end_of(whole)).norm(), 0.05) << estimator << ' ' << gap;
      EXPECT_FALSE(names_lost_position(result)) << estimator;
    }
  }
}

TEST_F(OutageSimulation, TheHeadingIsFoundAgainWhereLegsAloneWentOn) {
  const Time turning = turned_by(0.4);
  const EstimatorResult whole = without("aims_d", 0, 0);
  for (const Duration gap : {kSecond, 3 * kSecond / 2}) {
    const EstimatorResult result = without("aims_d", turning, turning + gap, true);
    EXPECT_EQ(result.counts.at("lidar.heading_searched"), 1) << gap;
    EXPECT_LT((end_of(result) - end_of(whole)).norm(), 0.05) << gap;
  }
}

TEST_F(OutageSimulation, AWalkIsFoundAgainAndALongGapIsSaid) {
  const Time walking = turned_by(0.4) - 4 * kSecond;
  const EstimatorResult whole = without("aims_d", 0, 0);
  const EstimatorResult brief = without("aims_d", walking, walking + kSecond);
  EXPECT_LT((end_of(brief) - end_of(whole)).norm(), 0.05);
  const EstimatorResult lengthy = without("aims_d", walking, walking + 8 * kSecond);
  EXPECT_TRUE(names_lost_position(lengthy));
  EXPECT_EQ(lengthy.health.back().state, HealthState::kDegraded);
  for (const StampedPose& pose : lengthy.trajectory) {
    ASSERT_LT(pose.pose.translation.norm(), 8.0) << "flung away";
  }
}

TEST_F(OutageSimulation, WithoutALidarAnyGapLosesThePosition) {
  const Time turning = turned_by(0.4);
  EXPECT_TRUE(names_lost_position(without("leg_inertial", turning, turning + kSecond)));
}

}  // namespace
}  // namespace aims
