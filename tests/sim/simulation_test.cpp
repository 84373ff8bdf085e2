// SPDX-License-Identifier: BSD-3-Clause
#include "sim/simulation.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace aims {
namespace {

/// Two metres of a corridor, seen by a coarse LiDAR.
SimulationConfig short_walk() {
  SimulationConfig config;
  config.scene.corridor.length = 10.0;
  config.route.points = {{"a", 0.0, 0.0}, {"b", 2.0, 0.0}};
  config.route.stand_before = 1.0;
  config.route.stand_after = 0.5;
  config.lidar.columns = 64;
  return config;
}

struct Recording {
  std::vector<Delivery> deliveries;
  Truth truth;
  SensorRig rig;
};

Recording record(const SimulationConfig& config, std::uint64_t seed, Duration span = kSecond,
                 int threads = 1) {
  Simulation simulation = Simulation::create(config, seed, threads).value();
  Recording result;
  while (simulation.advance(span, result.deliveries)) {
  }
  result.truth = simulation.truth();
  result.rig = simulation.rig();
  return result;
}

/// The samples of one sensor as bytes.
template <class Sample>
std::string bytes_of(const Recording& recording) {
  std::string bytes;
  const auto append = [&bytes](const auto& value) {
    const auto* data = reinterpret_cast<const char*>(&value);
    bytes.append(data, sizeof(value));
  };
  for (const Delivery& delivery : recording.deliveries) {
    const auto* sample = std::get_if<Sample>(&delivery.measurement);
    if (sample == nullptr) continue;
    append(delivery.arrival);
    if constexpr (std::is_same_v<Sample, ImuSample>) {
      append(sample->stamp);
      for (int i = 0; i < 3; ++i) {
        append(sample->angular_velocity[i]);
        append(sample->specific_force[i]);
      }
    } else if constexpr (std::is_same_v<Sample, LegOdometrySample>) {
      append(sample->stamp);
      for (int i = 0; i < 3; ++i) append(sample->T_odom_base.translation[i]);
      for (int i = 0; i < 4; ++i) append(sample->T_odom_base.rotation.coeffs()[i]);
      for (const double rate : sample->joint_velocity) append(rate);
    } else {
      for (const LidarPoint& point : (*sample)->points) {
        for (int i = 0; i < 3; ++i) append(point.position[i]);
        append(point.time_offset_ns);
      }
    }
  }
  return bytes;
}

TEST(Simulation, WalksItsRouteAndDeliversEverySensorInOrderOfArrival) {
  const Recording result = record(short_walk(), 1);
  EXPECT_EQ(result.truth.walk.end, WalkEnd::kRouteDone);
  EXPECT_FALSE(result.truth.walk.touched_wall);
  EXPECT_EQ(result.truth.walk.wall_contact_fraction, 0.0);
  ASSERT_EQ(result.truth.waypoint_times.size(), 2U);
  EXPECT_EQ(result.truth.waypoint_times[1].point, "b");
  std::array<std::size_t, 3> counts{};
  Time last = 0;
  for (const Delivery& delivery : result.deliveries) {
    EXPECT_GE(delivery.arrival, last);
    last = delivery.arrival;
    ++counts[delivery.measurement.index()];
  }
  const double seconds = to_seconds(result.truth.samples.back().stamp);
  EXPECT_NEAR(static_cast<double>(counts[0]), 50.0 * seconds, 1.0);
  EXPECT_NEAR(static_cast<double>(counts[1]), 0.95 * 200.0 * seconds, 0.02 * 200.0 * seconds);
  EXPECT_NEAR(static_cast<double>(counts[2]), 10.0 * seconds, 1.0);
}

TEST(Simulation, SameSeedGivesTheSameBytesWhateverTheSpan) {
  const Recording once = record(short_walk(), 7, kSecond);
  const Recording again = record(short_walk(), 7, 130 * kMillisecond);
  EXPECT_EQ(bytes_of<ImuSample>(once), bytes_of<ImuSample>(again));
  EXPECT_EQ(bytes_of<LegOdometrySample>(once), bytes_of<LegOdometrySample>(again));
  EXPECT_EQ(bytes_of<LidarScanPtr>(once), bytes_of<LidarScanPtr>(again));
  EXPECT_EQ(once.truth.snapshots.back().qpos, again.truth.snapshots.back().qpos);
  EXPECT_NE(bytes_of<ImuSample>(once), bytes_of<ImuSample>(record(short_walk(), 8)));
}

/// Everything that a scan's cast puts somewhere.
std::string scan_bytes_of(const Recording& recording) {
  std::string bytes = bytes_of<LidarScanPtr>(recording);
  const auto append = [&bytes](const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  };
  for (const Delivery& delivery : recording.deliveries) {
    const auto* scan = std::get_if<LidarScanPtr>(&delivery.measurement);
    if (scan == nullptr) continue;
    append(&(*scan)->stamp, sizeof(Time));
    append(&(*scan)->end, sizeof(Time));
    for (const LidarPoint& point : (*scan)->points) append(&point.intensity, sizeof(float));
  }
  for (const ScanInformation& scan : recording.truth.scans) {
    append(&scan.stamp, sizeof(Time));
    append(scan.information.data(), 36 * sizeof(double));
    append(&scan.range_sigma, sizeof(double));
  }
  return bytes;
}

TEST(Simulation, TheBytesDoNotDependOnTheThreads) {
  SimulationConfig plain = short_walk();
  SimulationConfig lossy = plain;  // scans that are lost, come twice, late, and with other stamps
  lossy.links.lidar.loss = 0.3;
  lossy.links.lidar.duplicate_probability = 0.3;
  lossy.links.lidar.delay = 0.35;
  lossy.links.lidar.jitter = 0.2;
  lossy.links.lidar.stamp_jitter = 0.01;
  for (const SimulationConfig& config : {plain, lossy}) {
    const Recording one = record(config, 7, kSecond);
    const Recording two = record(config, 7, 400 * kMillisecond, 2);
    EXPECT_GT(bytes_of<LidarScanPtr>(one).size(), 100'000U);
    EXPECT_EQ(scan_bytes_of(one), scan_bytes_of(two));
    EXPECT_EQ(bytes_of<ImuSample>(one), bytes_of<ImuSample>(two));
    EXPECT_EQ(bytes_of<LegOdometrySample>(one), bytes_of<LegOdometrySample>(two));
    EXPECT_EQ(one.truth.samples.size(), two.truth.samples.size());
  }
}

TEST(Simulation, StartsNearTheFirstPointWithAnOffsetPerSeed) {
  SimulationConfig config = short_walk();
  config.max_duration = 0.05;
  const auto start = [&config](std::uint64_t seed) {
    const Recording recording = record(config, seed);
    return (recording.truth.samples.front().T_world_body * recording.rig.T_body_base).translation;
  };
  EXPECT_NE(start(1).head<2>(), start(2).head<2>());
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_LT(start(seed).head<2>().norm(), 0.09) << "seed " << seed;
  }
}

/// Mounts and legs are of the robot, start and noise of the run.
TEST(Simulation, ARobotKeepsItsErrorsOverItsRuns) {
  SimulationConfig config = short_walk();
  config.calibration = {.rotation_sigma_deg = 0.5, .translation_sigma = 0.01};
  const Recording own = record(config, 5);
  config.robot_seed = 5;
  const Recording named = record(config, 5);
  EXPECT_EQ(bytes_of<ImuSample>(own), bytes_of<ImuSample>(named));
  EXPECT_EQ(bytes_of<LegOdometrySample>(own), bytes_of<LegOdometrySample>(named));
  EXPECT_EQ(bytes_of<LidarScanPtr>(own), bytes_of<LidarScanPtr>(named));
  const Recording again = record(config, 6);
  EXPECT_EQ(again.truth.mounts.T_body_lidar.translation, own.truth.mounts.T_body_lidar.translation);
  EXPECT_EQ(again.truth.mounts.T_base_body.rotation.coeffs(),
            own.truth.mounts.T_base_body.rotation.coeffs());
  EXPECT_NE(bytes_of<ImuSample>(own), bytes_of<ImuSample>(again));
  config.robot_seed = 6;
  EXPECT_NE(record(config, 6).truth.mounts.T_body_lidar.translation,
            own.truth.mounts.T_body_lidar.translation);
}

TEST(Simulation, ADrawOfSensorsLeavesWalkAndSceneUntouched) {
  SimulationConfig config = short_walk();
  config.calibration = {.rotation_sigma_deg = 0.5, .translation_sigma = 0.01};
  config.links.lidar.clock_offset_sigma = 0.01;
  const Recording shared = record(config, 5);
  config.sensor_draw = "one";
  const Recording one = record(config, 5);
  EXPECT_EQ(bytes_of<ImuSample>(one), bytes_of<ImuSample>(record(config, 5)));
  config.sensor_draw = "other";
  const Recording other = record(config, 5);
  const auto mount = [](const Recording& r) { return r.truth.mounts.T_body_lidar.translation; };
  EXPECT_NE(mount(one), mount(shared));
  EXPECT_NE(mount(one), mount(other));
  EXPECT_NE(bytes_of<ImuSample>(one), bytes_of<ImuSample>(other));
  EXPECT_NE(bytes_of<LidarScanPtr>(one), bytes_of<LidarScanPtr>(other));
  ASSERT_EQ(one.truth.snapshots.size(), other.truth.snapshots.size());
  EXPECT_EQ(one.truth.snapshots.back().qpos, shared.truth.snapshots.back().qpos);
  EXPECT_EQ(one.truth.snapshots.back().qpos, other.truth.snapshots.back().qpos);
}

TEST(Simulation, OneSensorsNoiseLeavesTheOthersUntouched) {
  const Recording base = record(short_walk(), 5);
  SimulationConfig changed = short_walk();
  changed.lidar.range_sigma = 0.1;
  changed.links.leg_odometry.loss = 0.5;
  changed.leg_odometry.slip_rate = 3.0;
  const Recording other = record(changed, 5);
  EXPECT_EQ(bytes_of<ImuSample>(base), bytes_of<ImuSample>(other));
  EXPECT_NE(bytes_of<LidarScanPtr>(base), bytes_of<LidarScanPtr>(other));
  EXPECT_NE(bytes_of<LegOdometrySample>(base), bytes_of<LegOdometrySample>(other));
}

TEST(Simulation, TruthIsConsistentWithItself) {
  const Recording result = record(short_walk(), 2);
  const auto& samples = result.truth.samples;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double dt = to_seconds(samples[i].stamp - samples[i - 1].stamp);
    EXPECT_DOUBLE_EQ(dt, 0.0025);
    const Eigen::Vector3d moved =
        samples[i].T_world_body.translation - samples[i - 1].T_world_body.translation;
    ASSERT_LT((moved / dt - samples[i].velocity).norm(), 0.02);
  }
  EXPECT_EQ(result.truth.snapshots.at(1).stamp, 100 * kMillisecond);
  EXPECT_EQ(body_trajectory(result.truth).size(), samples.size());
  EXPECT_GT(result.rig.T_body_lidar.translation.z(), 0.1);
  EXPECT_GT(result.rig.T_body_base.translation.x(), 0.1);
}

TEST(Simulation, RefusesARobotThatStartsInAWall) {
  SimulationConfig config = short_walk();
  config.route.points[0].y = 1.05;
  const auto simulation = Simulation::create(config, 1);
  ASSERT_FALSE(simulation);
  EXPECT_NE(simulation.error().message.find("route.points.0"), std::string::npos);
}

TEST(Simulation, ARouteIsCheckedWithoutBuildingTheRobot) {
  SimulationConfig config = short_walk();
  config.robot.model = "none";
  EXPECT_FALSE(Simulation::create(config, 1));
  EXPECT_TRUE(check_walk(config, 1));
  config.route.points[0].y = 1.05;
  const auto in_a_wall = check_walk(config, 1);
  ASSERT_FALSE(in_a_wall);
  EXPECT_NE(in_a_wall.error().message.find("route.points.0"), std::string::npos);
}

TEST(Simulation, RefusesARouteWithoutLengthAndAStepThatDividesNoPeriod) {
  SimulationConfig config = short_walk();
  config.route.points[1] = config.route.points[0];
  EXPECT_FALSE(Simulation::create(config, 1));
  config = short_walk();
  config.physics.timestep = 0.002;
  EXPECT_FALSE(Simulation::create(config, 1));
}

TEST(Simulation, EndsAtItsTimeLimit) {
  SimulationConfig config = short_walk();
  config.max_duration = 0.5;
  const Truth truth = record(config, 1).truth;
  EXPECT_EQ(truth.samples.back().stamp, 500 * kMillisecond);
  EXPECT_EQ(truth.walk.end, WalkEnd::kTimeLimit);
}

TEST(Simulation, ALaterRecordingStartShowsTheSameMotion) {
  SimulationConfig config = short_walk();
  const Recording whole = record(config, 1);
  config.recording_start = 2.5;  // the robot is on its way
  const Recording late = record(config, 1);
  const Time start = from_seconds(2.5);
  ASSERT_FALSE(late.truth.samples.empty());
  EXPECT_EQ(late.truth.samples.front().stamp, start);
  EXPECT_GT(late.truth.samples.front().velocity.norm(), 0.2);
  for (const Delivery& each : late.deliveries) EXPECT_GE(stamp_of(each.measurement), start);
  const std::size_t skipped = whole.truth.samples.size() - late.truth.samples.size();
  for (std::size_t i = 0; i < late.truth.samples.size(); ++i) {
    EXPECT_EQ(late.truth.samples[i].T_world_body.translation,
              whole.truth.samples[skipped + i].T_world_body.translation);
  }
  ASSERT_EQ(late.truth.waypoint_times.size(), 1U) << "the first point was passed before";
  EXPECT_EQ(late.truth.waypoint_times[0].point, "b");
}

TEST(Simulation, RefusesARecordingThatWouldBeginAfterItsEnd) {
  SimulationConfig config = short_walk();
  config.recording_start = config.max_duration;
  const auto refused = Simulation::create(config, 1);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("recording_start"), std::string::npos);
}

TEST(Simulation, EveryParameterIsDescribed) {
  SimulationConfig config;
  Fields fields = fields_of(config);
  for (const Parameter& parameter : fields.parameters()) {
    EXPECT_FALSE(parameter.spec.meaning.empty()) << parameter.key;
  }
  EXPECT_TRUE(assign(fields, "leg_odometry.foot_model", "rolling"));
  EXPECT_EQ(config.leg_odometry.foot_model, FootModel::kRolling);
  EXPECT_NE(fields.find("robot.gait.forces.friction"), nullptr);
}

TEST(Simulation, TheSecondImuOutputChangesNothingElse) {
  SimulationConfig config = short_walk();
  const Recording without = record(config, 3);
  config.fast_imu_rate = 200.0;
  Simulation simulation = Simulation::create(config, 3).value();
  Recording with;
  std::vector<ImuSample> fast;
  for (bool walking = true; walking;) {
    walking = simulation.advance(kSecond, with.deliveries);
    for (const ImuSample& sample : simulation.take_fast_imu()) fast.push_back(sample);
  }
  EXPECT_EQ(bytes_of<ImuSample>(with), bytes_of<ImuSample>(without));
  EXPECT_EQ(bytes_of<LegOdometrySample>(with), bytes_of<LegOdometrySample>(without));
  EXPECT_TRUE(simulation.take_fast_imu().empty());
  EXPECT_NEAR(to_seconds(fast.back().stamp - fast.front().stamp),
              static_cast<double>(fast.size() - 1) * 0.005, 1e-9);
  Eigen::Vector3d slow_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d fast_mean = Eigen::Vector3d::Zero();
  int slow_count = 0;
  for (const Delivery& delivery : with.deliveries) {
    if (const auto* sample = std::get_if<ImuSample>(&delivery.measurement)) {
      slow_mean += sample->angular_velocity;
      ++slow_count;
    }
  }
  for (const ImuSample& sample : fast) fast_mean += sample.angular_velocity;
  EXPECT_LT((slow_mean / slow_count - fast_mean / fast.size()).norm(), 3e-3) << "one sensor's bias";
}

}  // namespace
}  // namespace aims
