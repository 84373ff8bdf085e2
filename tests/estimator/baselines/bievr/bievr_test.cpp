// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/bievr.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/kinematic_world.hpp"

namespace aims::bievr {
namespace {

/// A walk of 2.5 m there and back between end walls 21.5 m apart: a box.
class BievrInABox : public ::testing::Test {
 protected:
  BievrInABox() : world_(aims::test::short_walk()), deliveries_(aims::test::record(world_)) {}

  /// The result on the deliveries for which `keep` is true; `keep` may change them.
  EstimatorResult run(const std::function<bool(Delivery&)>& keep = [](Delivery&) {
    return true;
  }) const {
    Bievr estimator(Config(), world_.rig());
    for (Delivery delivery : deliveries_) {
      if (keep(delivery)) estimator.consume(delivery);
    }
    estimator.finish();
    EXPECT_FALSE(estimator.map_points().empty());
    return estimator.result();
  }

  /// Largest error of a result [m].
  double largest_error(const EstimatorResult& result) const {
    return aims::test::largest_error(result.trajectory, world_);
  }

  aims::test::KinematicWorld world_;
  std::vector<Delivery> deliveries_;
};

bool is_scan(const Delivery& delivery) { return delivery.measurement.index() == 2; }

TEST_F(BievrInABox, StaysWithinCentimetres) {
  const EstimatorResult result = run();
  ASSERT_GT(result.trajectory.size(), 150U);
  EXPECT_EQ(result.trajectory.size(), result.diagnostics.scans.size());
  EXPECT_LT(result.trajectory.front().pose.translation.norm(), 1e-3);
  EXPECT_LT(largest_error(result), 0.1);
}

TEST_F(BievrInABox, LegsMakeNoDifference) {
  const EstimatorResult with = run();
  const EstimatorResult without = run([](Delivery& each) { return each.measurement.index() != 1; });
  ASSERT_EQ(with.trajectory.size(), without.trajectory.size());
  EXPECT_EQ(with.trajectory.back().pose.translation, without.trajectory.back().pose.translation);
}

TEST_F(BievrInABox, EmptyScansAreCountedAndPredictedThrough) {
  int scans = 0;
  const EstimatorResult result = run([&](Delivery& each) {
    if (is_scan(each) && ++scans % 10 == 0) {
      LidarScan empty = *std::get<LidarScanPtr>(each.measurement);
      empty.points.clear();
      each.measurement = std::make_shared<const LidarScan>(empty);
    }
    return true;
  });
  EXPECT_GT(result.counts.at("lidar.no_update"), 5);
  EXPECT_LT(largest_error(result), 0.2);
}

TEST_F(BievrInABox, PointsThatAreNoNumbersChangeNothing) {
  const EstimatorResult result = run([](Delivery& each) {
    if (!is_scan(each)) return true;
    LidarScan scan = *std::get<LidarScanPtr>(each.measurement);
    scan.points.front().position.setConstant(std::numeric_limits<float>::quiet_NaN());
    each.measurement = std::make_shared<const LidarScan>(scan);
    return true;
  });
  EXPECT_LT(largest_error(result), 0.1);
}

}  // namespace
}  // namespace aims::bievr
