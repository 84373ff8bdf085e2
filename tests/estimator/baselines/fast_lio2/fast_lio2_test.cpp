// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/fast_lio2.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/support/kinematic_world.hpp"

namespace aims::fast_lio2 {
namespace {

/// A walk of 2.5 m there and back between end walls 21.5 m apart: a box.
class FastLio2InABox : public ::testing::Test {
 protected:
  FastLio2InABox() : world_(aims::test::short_walk()), deliveries_(aims::test::record(world_)) {}

  /// Every return of the coarse LiDAR, in small voxels.
  static Config fine() {
    Config config;
    config.points.every_nth = 1;
    config.points.voxel = 0.2;
    config.map.voxel = 0.2;
    return config;
  }

  /// The result on the deliveries for which `keep` is true; `keep` may change them.
  EstimatorResult run(
      const Config& config,
      const std::function<bool(Delivery&)>& keep = [](Delivery&) { return true; }) const {
    FastLio2 estimator(config, world_.rig());
    for (Delivery delivery : deliveries_) {
      if (keep(delivery)) estimator.consume(delivery);
    }
    estimator.finish();
    return estimator.result();
  }

  /// Largest error of a result [m].
  double largest_error(const EstimatorResult& result) const {
    return aims::test::largest_error(result.trajectory, world_);
  }

  aims::test::KinematicWorld world_;
  std::vector<Delivery> deliveries_;
};

bool is_imu(const Delivery& delivery) { return delivery.measurement.index() == 0; }
bool is_legs(const Delivery& delivery) { return delivery.measurement.index() == 1; }
bool is_scan(const Delivery& delivery) { return delivery.measurement.index() == 2; }

TEST_F(FastLio2InABox, StaysWithinCentimetres) {
  const EstimatorResult result = run(fine());
  ASSERT_GT(result.trajectory.size(), 150U);
  EXPECT_EQ(result.trajectory.size(), result.diagnostics.scans.size());
  EXPECT_LT(result.trajectory.front().pose.translation.norm(), 1e-3);
  EXPECT_LT(largest_error(result), 0.1);
}

TEST_F(FastLio2InABox, LegsMakeNoDifference) {
  const EstimatorResult with = run(Config());
  const EstimatorResult without = run(Config(), [](Delivery& each) { return !is_legs(each); });
  ASSERT_EQ(with.trajectory.size(), without.trajectory.size());
  EXPECT_EQ(with.trajectory.back().pose.translation, without.trajectory.back().pose.translation);
}

TEST_F(FastLio2InABox, TheFirstScansStartItAndAreNotReported) {
  const EstimatorResult result = run(Config());
  Time second_scan = 0;
  int scans = 0;
  for (const Delivery& each : deliveries_) {
    const auto* scan = std::get_if<LidarScanPtr>(&each.measurement);
    if (scan != nullptr && ++scans == 2) second_scan = (*scan)->end;
  }
  EXPECT_GT(result.trajectory.front().stamp, second_scan);
  EXPECT_LT(result.trajectory.front().stamp, second_scan + kSecond);
  EXPECT_EQ(result.diagnostics.value(0, "iterations"), 0.0);  // the map begins
  EXPECT_GT(result.diagnostics.value(1, "iterations"), 0.0);
}

TEST_F(FastLio2InABox, ReportsItsResidualsAndWhatTheyConstrain) {
  const EstimatorResult result = run(Config());
  const std::size_t last = result.diagnostics.scans.size() - 1;
  const auto value = [&](const char* name) { return result.diagnostics.value(last, name); };
  EXPECT_GT(value("points_used"), 50.0);
  EXPECT_LE(value("points_used"), value("points_in"));
  EXPECT_LT(value("residual_mean"), 0.05);
  EXPECT_GT(value("smallest_eigenvalue"), 0.0);
  EXPECT_GE(value("condition_number"), 1.0);
  EXPECT_LE(value("localizability"), value("points_used"));
  EXPECT_GT(value("localizability"), 0.0);
}

TEST_F(FastLio2InABox, ScansWithoutImuAreCountedAndSkipped) {
  const Time begin = deliveries_.front().arrival + 4 * kSecond;
  const EstimatorResult result = run(Config(), [&](Delivery& each) {
    return !is_imu(each) || each.arrival < begin || each.arrival > begin + kSecond / 2;
  });
  EXPECT_GT(result.counts.at("lidar.without_imu"), 2);
  EXPECT_LT(largest_error(result), 0.5);
}

TEST_F(FastLio2InABox, EmptyScansAreCountedAndPredictedThrough) {
  int scans = 0;
  const EstimatorResult result = run(Config(), [&](Delivery& each) {
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

TEST_F(FastLio2InABox, PointsThatAreNoNumbersChangeNothing) {
  const EstimatorResult result = run(fine(), [](Delivery& each) {
    if (!is_scan(each)) return true;
    LidarScan scan = *std::get<LidarScanPtr>(each.measurement);
    for (std::size_t i = 0; i < scan.points.size(); i += 30) {
      scan.points[i].position.y() = i % 60 == 0 ? std::numeric_limits<float>::quiet_NaN() : 1e30F;
    }
    each.measurement = std::make_shared<const LidarScan>(scan);
    return true;
  });
  EXPECT_LT(largest_error(result), 0.1);
}

TEST_F(FastLio2InABox, AStateThatRunsAwayEndsTheEstimateWithoutAnException) {
  // Large but allowed forces, and stamps 20 s apart: the position leaves every bound.
  Duration late = 0;
  const Time begin = deliveries_.front().arrival + 4 * kSecond;
  const EstimatorResult result = run(Config(), [&](Delivery& each) {
    if (each.arrival < begin) return true;
    if (auto* sample = std::get_if<ImuSample>(&each.measurement)) {
      sample->specific_force *= 25.0;
    }
    if (is_scan(each)) late += 20 * kSecond;
    each.arrival += late;
    if (auto* sample = std::get_if<ImuSample>(&each.measurement)) sample->stamp += late;
    if (is_scan(each)) {
      LidarScan scan = *std::get<LidarScanPtr>(each.measurement);
      scan.stamp += late;
      scan.end += late;
      each.measurement = std::make_shared<const LidarScan>(scan);
    }
    return !is_legs(each);
  });
  EXPECT_GT(result.counts.at("filter.rejected"), 0);
  for (const StampedPose& each : result.trajectory) {
    EXPECT_TRUE(each.pose.translation.allFinite());
  }
}

TEST_F(FastLio2InABox, ThePublishedMinimumRangeLeavesFewPoints) {
  const EstimatorResult corridor = run(Config());
  const EstimatorResult published = run(fast_lio2::published());
  const std::size_t last = corridor.diagnostics.scans.size() - 1;
  EXPECT_LT(published.diagnostics.value(last, "points_in"),
            corridor.diagnostics.value(last, "points_in"));
}

}  // namespace
}  // namespace aims::fast_lio2
