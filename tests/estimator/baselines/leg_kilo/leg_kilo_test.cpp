// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/leg_kilo.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <limits>

#include "core/leg_kinematics.hpp"
#include "tests/support/kinematic_world.hpp"

namespace aims::leg_kilo {
namespace {

using Keep = std::function<bool(Delivery&)>;

bool is_imu(const Delivery& delivery) { return delivery.measurement.index() == 0; }
bool is_legs(const Delivery& delivery) { return delivery.measurement.index() == 1; }
bool is_scan(const Delivery& delivery) { return delivery.measurement.index() == 2; }
bool keep_all(Delivery&) { return true; }

/// A sequence of a kinematic world.
class Walk {
 public:
  explicit Walk(const aims::test::KinematicConfig& config)
      : world_(config), rig_(world_.rig()), deliveries_(aims::test::record(world_)) {}

  /// The result on the deliveries for which `keep` is true; `keep` may change them.
  EstimatorResult run(const Config& config, const Keep& keep = keep_all) const {
    LegKilo estimator(config, rig_);
    for (Delivery delivery : deliveries_) {
      if (keep(delivery)) estimator.consume(delivery);
    }
    estimator.finish();
    return estimator.result();
  }

  /// Largest distance [m] from the truth after alignment at the first pose; along x alone with
  /// `along`.
  double largest_error(const EstimatorResult& result, bool along = false) const {
    const Pose T_world_odom = aims::test::T_world_odom(result.trajectory, world_);
    double largest = 0.0;
    for (const StampedPose& each : result.trajectory) {
      const Eigen::Vector3d error =
          (T_world_odom * each.pose).translation - world_.T_world_body(each.stamp).translation;
      if (!error.allFinite()) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, along ? std::abs(error.x()) : error.norm());
    }
    return largest;
  }

  Time begin() const { return deliveries_.front().arrival; }
  Time end() const { return deliveries_.back().arrival; }
  SensorRig& rig() { return rig_; }

 private:
  aims::test::KinematicWorld world_;
  SensorRig rig_;
  std::vector<Delivery> deliveries_;
};

/// A walk of 4 m in a smooth corridor of which no scan reaches an end; legs without error.
aims::test::KinematicConfig smooth_corridor() {
  aims::test::KinematicConfig config;
  config.walk.distance = 4.0;
  config.walk.there_and_back = false;
  config.corridor.door_spacing = 0.0;
  config.corridor.begin = -200.0;
  config.corridor.end = 200.0;
  config.corridor.open_ends = true;
  config.sensors.lidar_columns = 450;
  config.sensors.lidar_range = 30.0;
  config.sensors.leg_scale_error = 0.0;
  config.sensors.leg_noise = 0.0;
  config.sensors.leg_slow_noise = 0.0;
  return config;
}

Config every_return() {
  Config config;
  config.points.every_nth = 1;
  return config;
}

Config without_legs() {
  Config config = every_return();
  config.legs.enabled = false;
  return config;
}

double mean_feet(const EstimatorResult& result, std::size_t from, std::size_t to) {
  double sum = 0.0;
  for (std::size_t i = from; i < to; ++i) sum += result.diagnostics.value(i, "standing_feet");
  return sum / static_cast<double>(to - from);
}

TEST(LegKiloInABox, StaysWithinCentimetres) {
  const Walk walk(aims::test::short_walk());
  const EstimatorResult result = walk.run(every_return());
  ASSERT_GT(result.trajectory.size(), 150U);
  EXPECT_EQ(result.trajectory.size(), result.diagnostics.scans.size());
  EXPECT_EQ(result.trajectory.front().pose.translation.norm(), 0.0);
  EXPECT_LT(walk.largest_error(result), 0.15);
  EXPECT_LT(walk.largest_error(walk.run(without_legs())), 0.6);
}

TEST(LegKiloInABox, ReportsItsResidualsAndWhatTheyConstrain) {
  const EstimatorResult result = Walk(aims::test::short_walk()).run(every_return());
  const std::size_t last = result.diagnostics.scans.size() - 1;
  const auto value = [&](const char* name) { return result.diagnostics.value(last, name); };
  EXPECT_GT(value("points_used"), 50.0);
  EXPECT_LE(value("points_used"), value("points_in"));
  EXPECT_LE(value("iterations"), value("points_used"));
  EXPECT_GT(value("iterations"), 10.0);
  EXPECT_LT(value("residual_mean"), 0.08);
  EXPECT_GT(value("smallest_eigenvalue"), 0.0);
  EXPECT_GE(value("condition_number"), 1.0);
  EXPECT_LE(value("localizability"), value("points_used"));
  EXPECT_NEAR(value("standing_feet"), 4.0, 2.0);
  EXPECT_EQ(result.diagnostics.value(0, "iterations"), 0.0);  // the map begins
}

// Without legs, the smooth corridor leaves its direction to the accelerometer.
TEST(LegKiloInASmoothCorridor, LegsAloneMeasureTheDistance) {
  const Walk walk(smooth_corridor());
  EXPECT_LT(walk.largest_error(walk.run(every_return()), true), 0.25);
  EXPECT_GT(walk.largest_error(walk.run(without_legs()), true), 0.5);
}

TEST(LegKiloInASmoothCorridor, ALegScaleErrorBecomesADistanceError) {
  aims::test::KinematicConfig config = smooth_corridor();
  config.sensors.leg_scale_error = 0.1;
  const Walk walk(config);
  EXPECT_NEAR(walk.largest_error(walk.run(every_return()), true), 0.4, 0.15);
}

TEST(LegKiloLegs, JointsOfFeetInContactAndTheTwistGiveTheSameMotion) {
  Walk walk(smooth_corridor());
  walk.rig().leg_geometry = {.hip_x = 0.19,
                             .hip_y = 0.05,
                             .abduction = 0.08,
                             .thigh = 0.21,
                             .calf = 0.22,
                             .foot_radius = 0.02};
  // Two feet in contact stand; the other two swing backwards at 2 m/s.
  const auto with_joints = [&walk](Delivery& each) {
    auto* sample = std::get_if<LegOdometrySample>(&each.measurement);
    if (sample == nullptr) return true;
    for (int leg = 0; leg < kLegCount; ++leg) {
      const LegGeometry& geometry = walk.rig().leg_geometry;
      const Eigen::Vector3d q(0.05, 0.8, -1.6);
      const double swing = sample->contact[static_cast<std::size_t>(leg)] ? 0.0 : 2.0;
      const Eigen::Vector3d moving = -sample->linear_velocity - swing * Eigen::Vector3d::UnitX() -
                                     sample->angular_velocity.cross(foot_in_base(leg, q, geometry));
      const Eigen::Vector3d rate = foot_jacobian(leg, q, geometry).inverse() * moving;
      for (int k = 0; k < 3; ++k) {
        sample->joint_position[static_cast<std::size_t>(3 * leg + k)] = q(k);
        sample->joint_velocity[static_cast<std::size_t>(3 * leg + k)] = rate(k);
      }
    }
    return true;
  };
  Config contacts = every_return();
  contacts.legs.feet = FeetFrom::kContacts;
  const EstimatorResult by_joints = walk.run(contacts, with_joints);
  EXPECT_LT(walk.largest_error(by_joints, true), 0.25);
  EXPECT_NEAR(mean_feet(by_joints, 20, 50), 2.0, 0.2);
  const EstimatorResult by_twist = walk.run(every_return(), with_joints);
  EXPECT_LT(walk.largest_error(by_twist, true), 0.25);
  EXPECT_NEAR(mean_feet(by_twist, 20, 50), 4.0, 0.4);
  EXPECT_NEAR(mean_feet(walk.run(contacts), 20, 50), 4.0, 0.4);  // no joints in the stream
}

TEST(LegKiloLegs, WithoutPacketsNoFootStandsAndTheImuIsUsedAlone) {
  const Walk walk(aims::test::short_walk());
  const EstimatorResult lost =
      walk.run(every_return(), [](Delivery& each) { return !is_legs(each); });
  const EstimatorResult disabled = walk.run(without_legs());
  ASSERT_EQ(lost.trajectory.size(), disabled.trajectory.size());
  EXPECT_EQ(lost.trajectory.back().pose.translation, disabled.trajectory.back().pose.translation);
  EXPECT_EQ(mean_feet(lost, 1, 20), 0.0);
}

TEST(LegKiloLegs, ABurstOfLostPacketsEndsTheKinematicRowsUntilTheNextOne) {
  const Walk walk(aims::test::short_walk());
  const Time begin = walk.begin() + 3 * kSecond;
  const EstimatorResult result = walk.run(every_return(), [&](Delivery& each) {
    return !is_legs(each) || each.arrival < begin || each.arrival >= begin + kSecond;
  });
  const auto feet = [&](Time from, Time to) {
    double sum = 0.0;
    for (std::size_t i = 1; i < result.diagnostics.scans.size(); ++i) {
      const Time stamp = result.diagnostics.scans[i].stamp;
      if (stamp > from && stamp < to) sum += result.diagnostics.value(i, "standing_feet");
    }
    return sum;
  };
  EXPECT_EQ(feet(begin + kSecond / 5, begin + kSecond), 0.0);
  EXPECT_GT(feet(begin + 6 * kSecond / 5, begin + 2 * kSecond), 15.0);
  EXPECT_LT(walk.largest_error(result), 0.15);
}

TEST(LegKiloLegs, LegDataAsOldAsTheLimitBelongToNoImuSample) {
  const Walk walk(aims::test::short_walk());
  // Packets that are stamped 12 ms before the IMU's samples, and none nearer.
  const Keep sparse = [](Delivery& each) {
    auto* sample = std::get_if<LegOdometrySample>(&each.measurement);
    if (sample == nullptr) return true;
    if (sample->stamp % (20 * kMillisecond) != 0) return false;
    sample->stamp += 8 * kMillisecond;
    return true;
  };
  Config config = every_return();
  config.legs.max_age = 0.012;
  EXPECT_EQ(mean_feet(walk.run(config, sparse), 1, 30), 0.0);
  config.legs.max_age = 0.0121;
  EXPECT_GT(mean_feet(walk.run(config, sparse), 1, 30), 3.0);
}

TEST(LegKiloInputs, ScansWithoutImuAreCountedAndSkipped) {
  const Walk walk(aims::test::short_walk());
  const Time begin = walk.begin() + 4 * kSecond;
  const EstimatorResult result = walk.run(every_return(), [&](Delivery& each) {
    return !is_imu(each) || each.arrival < begin || each.arrival > begin + kSecond / 2;
  });
  EXPECT_GT(result.counts.at("lidar.without_imu"), 2);
  // As published: rate and specific force stay as they were in the gap, and the map is then askew.
  EXPECT_LT(walk.largest_error(result), 20.0);
  EXPECT_GT(result.trajectory.back().stamp, walk.end() - kSecond / 2);
}

TEST(LegKiloInputs, EmptyScansAreCountedAndPredictedThrough) {
  const Walk walk(aims::test::short_walk());
  int scans = 0;
  const EstimatorResult result = walk.run(every_return(), [&](Delivery& each) {
    if (is_scan(each) && ++scans % 10 == 0) {
      LidarScan empty = *std::get<LidarScanPtr>(each.measurement);
      empty.points.clear();
      each.measurement = std::make_shared<const LidarScan>(empty);
    }
    return true;
  });
  EXPECT_GT(result.counts.at("lidar.no_update"), 5);
  EXPECT_LT(walk.largest_error(result), 0.5);
}

TEST(LegKiloInputs, PointsThatAreNoNumbersChangeNothing) {
  const Walk walk(aims::test::short_walk());
  const EstimatorResult result = walk.run(every_return(), [](Delivery& each) {
    if (!is_scan(each)) return true;
    LidarScan scan = *std::get<LidarScanPtr>(each.measurement);
    for (std::size_t i = 0; i < scan.points.size(); i += 30) {
      scan.points[i].position.y() = i % 60 == 0 ? std::numeric_limits<float>::quiet_NaN() : 1e30F;
    }
    each.measurement = std::make_shared<const LidarScan>(scan);
    return true;
  });
  EXPECT_LT(walk.largest_error(result), 0.15);
}

TEST(LegKiloInputs, AStateThatRunsAwayEndsTheEstimateWithoutAnException) {
  // Large but allowed forces, and stamps 20 s apart: the position leaves every bound.
  const Walk walk(aims::test::short_walk());
  Duration late = 0;
  const Time begin = walk.begin() + 4 * kSecond;
  const EstimatorResult result = walk.run(every_return(), [&](Delivery& each) {
    if (each.arrival < begin) return true;
    if (auto* sample = std::get_if<ImuSample>(&each.measurement)) sample->specific_force *= 25.0;
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

/// An IMU at rest and a scan with returns at the given times after its stamp; the last one, too
/// near to be used, ends it.
class StandingRobot {
 public:
  StandingRobot() : estimator_(every_return(), SensorRig()) {}

  void imu(Time stamp) {
    ImuSample sample;
    sample.stamp = stamp;
    sample.specific_force = {0.0, 0.0, 9.81};
    estimator_.consume({stamp, sample});
  }

  void scan(Time stamp, const std::vector<Duration>& offsets, Duration last) {
    LidarScan scan{.stamp = stamp, .end = stamp + last, .points = {}};
    for (const Duration offset : offsets) {
      const auto x = 5.0F + 2.0F * static_cast<float>(scan.points.size());
      scan.points.push_back(
          {.position = {x, 1.0F, 0.5F}, .time_offset_ns = static_cast<std::int32_t>(offset)});
    }
    scan.points.push_back(
        {.position = {0.1F, 0.0F, 0.0F}, .time_offset_ns = static_cast<std::int32_t>(last)});
    estimator_.consume({stamp + last, std::make_shared<const LidarScan>(scan)});
  }

  LegKilo& estimator() { return estimator_; }

 private:
  LegKilo estimator_;
};

// As published: the covariance is predicted from the last update to each group, so repeatedly while
// no point lies on a plane, and the sample after the last group is dropped.
TEST(LegKiloInputs, GroupsWithoutAPlaneRepeatThePredictionOfTheCovariance) {
  StandingRobot robot;
  robot.imu(50 * kMillisecond);
  robot.scan(0, {0}, 100 * kMillisecond);
  robot.imu(180 * kMillisecond);
  robot.scan(100 * kMillisecond, {10 * kMillisecond, 20 * kMillisecond, 30 * kMillisecond},
             90 * kMillisecond);
  robot.estimator().finish();

  Belief expected;
  expected.covariance = every_return().start.variance * ErrorMatrix::Identity();
  for (const double since_update : {0.01, 0.02, 0.03}) {
    expected.covariance =
        predicted_covariance(expected.covariance, expected.state, since_update, ProcessNoise());
    expected.state = predicted(expected.state, 0.01);
  }
  ASSERT_EQ(robot.estimator().result().trajectory.size(), 2U);
  const Belief& belief = robot.estimator().belief();
  EXPECT_LT((belief.covariance - expected.covariance).norm(), 1e-6 * expected.covariance.norm());
  EXPECT_LT((belief.state.velocity - expected.state.velocity).norm(), 1e-6);
  EXPECT_NEAR(belief.state.velocity.z(), -9.81 * 0.03, 1e-6);  // it falls until it is corrected
}

TEST(LegKiloPresets, ThePublishedMinimumRangeLeavesFewerPoints) {
  const Walk walk(aims::test::short_walk());
  const EstimatorResult corridor = walk.run(Config());
  const EstimatorResult with_published = walk.run(published());
  const std::size_t last = corridor.diagnostics.scans.size() - 1;
  EXPECT_LT(with_published.diagnostics.value(last, "points_in"),
            corridor.diagnostics.value(last, "points_in"));
}

}  // namespace
}  // namespace aims::leg_kilo
