// SPDX-License-Identifier: BSD-3-Clause
// The robots of models/: files against each other, against the dynamics, and walking.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "bench/run/record.hpp"
#include "bench/scenario/model_sheets.hpp"
#include "bench/scenario/scenario.hpp"
#include "core/leg_kinematics.hpp"
#include "core/random.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "sim/environment/mujoco_model.hpp"
#include "sim/sensors/scan_pattern.hpp"
#include "sim/simulation.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

Eigen::Vector3d vector_at(const mjtNum* data) { return {data[0], data[1], data[2]}; }

/// A robot alone, in the dynamics.
struct Dynamics {
  explicit Dynamics(std::string_view robot)
      : model(load_mujoco_model(robot_model(robot).value().mjcf, {}).value()),
        data(mj_makeData(model.get())) {
    mj_forward(model.get(), data.get());
  }
  int id(mjtObj type, const std::string& name) const {
    const int found = mj_name2id(model.get(), type, name.c_str());
    EXPECT_GE(found, 0) << name;
    return std::max(found, 0);
  }
  MujocoModel model;
  MujocoData data;
};

class RobotFiles : public ::testing::Test {
 protected:
  Result<Scenario> load(const std::vector<std::string>& settings,
                        const std::string& yaml = "seed: 1") const {
    std::ofstream(folder_.path() / "s.yaml") << yaml;
    return load_scenario(folder_.path() / "s.yaml", settings);
  }
  Scenario of_robot(std::string_view robot, std::vector<std::string> settings = {}) const {
    settings.insert(settings.begin(), fmt::format("robot.model={}", robot));
    auto scenario = load(settings);
    EXPECT_TRUE(scenario) << scenario.error().message;
    return scenario ? *scenario : Scenario();
  }
  std::string error_of(const std::vector<std::string>& settings,
                       const std::string& yaml = "seed: 1") const {
    const auto scenario = load(settings, yaml);
    return scenario ? "" : scenario.error().message;
  }
  TemporaryFolder folder_;
};

class RobotModels : public RobotFiles, public ::testing::WithParamInterface<const char*> {};

TEST_P(RobotModels, GeometryMountsAndMassOfTheFileAreThoseOfTheDynamics) {
  const RobotConfig robot = of_robot(GetParam()).simulation.robot;
  const Dynamics alone(GetParam());
  const mjModel* m = alone.model.get();
  for (int leg = 0; leg < kLegCount; ++leg) {
    const std::string name(kLegNames[leg]);
    SCOPED_TRACE(name);
    const auto body = [&](const char* part) {
      return vector_at(m->body_pos + 3 * alone.id(mjOBJ_BODY, name + part));
    };
    EXPECT_EQ(body("_hip"), hip_in_base(leg, robot.legs));
    EXPECT_EQ(body("_thigh"), Eigen::Vector3d(0.0, side_of(leg) * robot.legs.abduction, 0.0));
    EXPECT_EQ(body("_calf"), Eigen::Vector3d(0.0, 0.0, -robot.legs.thigh));
    const int foot = alone.id(mjOBJ_GEOM, name + "_foot");
    EXPECT_EQ(vector_at(m->geom_pos + 3 * foot), Eigen::Vector3d(0.0, 0.0, -robot.legs.calf));
    EXPECT_EQ(m->geom_size[3 * foot], robot.legs.foot_radius);
  }
  const auto mount_of = [&](const char* site) {
    const int id = alone.id(mjOBJ_SITE, site);
    const mjtNum* q = m->site_quat + 4 * id;
    return Pose{Eigen::Quaterniond(q[0], q[1], q[2], q[3]), vector_at(m->site_pos + 3 * id)};
  };
  const Mounts mounts = nominal_mounts(robot.mounts);
  const Pose imu = mount_of("imu");
  EXPECT_EQ(mounts.T_base_body.translation, imu.translation);
  EXPECT_TRUE(mounts.T_base_body.rotation.isApprox(imu.rotation));
  const Pose lidar = mounts.T_base_body * mounts.T_body_lidar;
  EXPECT_LT((lidar.translation - mount_of("lidar").translation).norm(), 1e-12);
  EXPECT_TRUE(lidar.rotation.isApprox(mount_of("lidar").rotation));
  SimulationConfig unused;
  const auto sheet = apply_robot_model(GetParam(), SensorLevel::kField, unused);
  ASSERT_TRUE(sheet) << sheet.error().message;
  EXPECT_NEAR(m->body_subtreemass[alone.id(mjOBJ_BODY, "trunk")], sheet->mass, 0.05);
}

TEST_P(RobotModels, KinematicsPutTheFeetWhereTheDynamicsHaveThem) {
  const LegGeometry legs = of_robot(GetParam()).simulation.robot.legs;
  const Dynamics alone(GetParam());
  const mjModel* m = alone.model.get();
  RandomStream random(5, "joints");
  for (int trial = 0; trial < 50; ++trial) {
    JointVector q;
    for (int i = 0; i < kJointCount; ++i) {
      const mjtNum* range = m->jnt_range + 2 * (i + 1);  // the first joint is that of the trunk
      q[i] = random.uniform(range[0], range[1]);
    }
    std::copy_n(q.data(), kJointCount, alone.data->qpos + 7);
    mj_forward(m, alone.data.get());
    const Eigen::Vector3d trunk = vector_at(alone.data->qpos);
    for (int leg = 0; leg < kLegCount; ++leg) {
      const int site = alone.id(mjOBJ_SITE, std::string(kLegNames[leg]) + "_foot");
      const Eigen::Vector3d foot = vector_at(alone.data->site_xpos + 3 * site) - trunk;
      const Eigen::Vector3d angles = joints_of(q, leg);
      EXPECT_LT((foot - foot_in_base(leg, angles, legs)).norm(), 1e-9) << "seed 5";
    }
  }
}

/// The beams that the mask leaves open pass beside every part of the robot, and those of the
/// blind sector do not.
TEST_P(RobotModels, TheBodyMaskCoversTheBody) {
  const Scenario scenario = of_robot(GetParam());
  const RobotConfig& robot = scenario.simulation.robot;
  const LidarConfig& lidar = scenario.simulation.lidar;
  const Dynamics alone(GetParam());
  const mjModel* m = alone.model.get();
  const JointVector standing = standing_joints(
      robot.legs, robot.gait.body_height - robot.legs.foot_radius, robot.gait.stance_width);
  std::copy_n(standing.data(), kJointCount, alone.data->qpos + 7);
  mj_forward(m, alone.data.get());
  const Eigen::Vector3d eye = vector_at(alone.data->site_xpos + 3 * alone.id(mjOBJ_SITE, "lidar"));
  // The collision parts (group 3) but for the LiDAR itself.
  m->geom_group[alone.id(mjOBJ_GEOM, "lidar")] = 5;
  const std::array<mjtByte, mjNGROUP> groups = {0, 0, 0, 1, 0, 0};
  const auto masked = [&](const Eigen::Vector3d& direction) {
    for (int i = 1; i < 2000; ++i) {
      const Eigen::Array3d at = (1e-3 * i * direction).array();
      if ((at > lidar.body_mask_min.array()).all() && (at < lidar.body_mask_max.array()).all()) {
        return true;
      }
    }
    return false;
  };
  int hits = 0;
  const auto firings = ScanPattern(lidar).firings(0);
  for (std::size_t i = 0; i < firings.size(); i += 7) {
    const Eigen::Vector3d direction = firings[i].beam.direction();
    int geom = -1;
    const mjtNum distance =
        mj_ray(m, alone.data.get(), eye.data(), direction.data(), groups.data(), 1, -1, &geom);
    if (distance < 0.0) continue;
    ++hits;
    EXPECT_TRUE(masked(direction)) << distance << " along " << direction.transpose();
  }
  // From the default robot's mast all beams pass over its trunk; the mask has a margin.
  EXPECT_EQ(hits > 0, scenario.simulation.robot.model != "quadruped");
}

struct Walked {
  Truth truth;
  std::vector<Delivery> deliveries;
  SensorRig rig;
};

Walked walk(const Scenario& scenario, std::uint64_t seed) {
  auto simulation = Simulation::create(scenario.simulation, seed);
  EXPECT_TRUE(simulation) << simulation.error().message;
  Walked walked;
  if (!simulation) return walked;
  while (simulation->advance(10 * kSecond, walked.deliveries)) {
  }
  walked.truth = simulation->truth();
  walked.rig = simulation->rig();
  return walked;
}

TEST_P(RobotModels, WalksOutTurnsAndReturnsOnLevelFloorOverARampAndUnderPushes) {
  const std::vector<std::string> small = {
      "scene.corridor.length=4", "route.points=[[a,0,0],[b,4,0],[a,0,0]]", "route.stand_before=1",
      "route.stand_after=0.5", "lidar.columns=16"};
  const std::vector<std::vector<std::string>> cases = {
      {},
      {"scene.ramp.start=1", "scene.ramp.length=2", "scene.ramp.grade=0.1"},
      {"push.count=4", "push.force=60", "push.duration=0.1", "push.start=2", "push.end=8"}};
  for (const auto& extra : cases) {
    std::vector<std::string> settings = small;
    settings.insert(settings.end(), extra.begin(), extra.end());
    const Walked walked = walk(of_robot(GetParam(), settings), 2);
    SCOPED_TRACE(extra.empty() ? "level" : extra.front());
    EXPECT_EQ(walked.truth.walk.end, WalkEnd::kRouteDone);
    EXPECT_FALSE(walked.truth.walk.touched_wall);
    ASSERT_EQ(walked.truth.waypoint_times.size(), 3U);
    for (const TruthSample& sample : walked.truth.samples) {
      ASSERT_LT(std::abs(sample.T_world_body.translation.y()), 0.45);
    }
  }
}

TEST_P(RobotModels, ARecordingGivesBackLegsMountsAndWhatTheLegsMeasured) {
  const Scenario scenario =
      of_robot(GetParam(), {"scene.corridor.length=4", "route.points=[[a,0,0],[b,1,0]]",
                            "max_duration=0.6", "lidar.columns=64", "links.leg_odometry.loss=0"});
  const auto bag = folder_.path() / "standing.bag";
  const auto recorded = record(scenario, {.seed = 1, .bag = bag}, [](auto&) { return true; });
  ASSERT_TRUE(recorded) << recorded.error().message;
  auto reader = RecordingReader::open(bag, {});
  ASSERT_TRUE(reader) << reader.error().message;
  const Walked walked = walk(scenario, 1);
  const SensorRig rig = reader->setup().rig;
  EXPECT_EQ(rig.leg_geometry, scenario.simulation.robot.legs);
  EXPECT_EQ(walked.rig.leg_geometry, scenario.simulation.robot.legs);
  EXPECT_LT((rig.T_body_lidar.translation - walked.rig.T_body_lidar.translation).norm(), 1e-12);
  EXPECT_LT((rig.T_body_base.translation - walked.rig.T_body_base.translation).norm(), 1e-12);
  const auto read = test::read_all(*reader);
  ASSERT_TRUE(read) << read.error().message;
  const auto of_legs = [](const std::vector<Delivery>& all) {
    std::vector<LegOdometrySample> samples;
    for (const Delivery& each : all) {
      const auto* sample = std::get_if<LegOdometrySample>(&each.measurement);
      if (sample != nullptr) samples.push_back(*sample);
    }
    return samples;
  };
  const auto wanted = of_legs(walked.deliveries);
  const auto got = of_legs(*read);
  ASSERT_GT(wanted.size(), 100U);
  ASSERT_EQ(got.size(), wanted.size());
  EXPECT_EQ(got.back().joint_position, wanted.back().joint_position);
  // A setting of the reader wins over what the recording states.
  RecordingConfig own;
  own.leg_geometry.thigh = 0.3;
  const auto other = RecordingReader::open(bag, own);
  ASSERT_TRUE(other);
  EXPECT_EQ(other->setup().rig.leg_geometry.thigh, 0.3);
}

TEST_P(RobotModels, AStoredConfigurationRepeatsThem) {
  const std::string text = effective_config(of_robot(GetParam()), 1);
  const auto again = load({}, text);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(effective_config(*again, 1), text);
}

INSTANTIATE_TEST_SUITE_P(Robots, RobotModels,
                         ::testing::Values("quadruped", "go2_class", "inspection_50kg"),
                         [](const auto& each) { return std::string(each.param); });

TEST_F(RobotFiles, KeysOfTheScenarioLieAboveTheModel) {
  const Scenario set =
      of_robot("go2_class", {"robot.gait.swing_height=0.05", "lidar.body_mask_max=[0,0,0]",
                             "robot.mounts.lidar.translation=[0,0,0.4]"});
  EXPECT_EQ(set.simulation.robot.gait.swing_height, 0.05);
  EXPECT_EQ(set.simulation.lidar.body_mask_max, Eigen::Vector3d::Zero());
  EXPECT_EQ(nominal_mounts(set.simulation.robot.mounts).T_base_body.translation,
            nominal_mounts(of_robot("go2_class").simulation.robot.mounts).T_base_body.translation);
  const Mounts mounts = nominal_mounts(set.simulation.robot.mounts);
  EXPECT_LT(
      ((mounts.T_base_body * mounts.T_body_lidar).translation - Eigen::Vector3d(0, 0, 0.4)).norm(),
      1e-12);
}

TEST_F(RobotFiles, TheDefaultIsTheQuadrupedAsItsFileStatesIt) {
  EXPECT_EQ(robot_models().front().name, RobotConfig().model);
  EXPECT_EQ(config_text(*load({})), config_text(*load({"robot.model=quadruped"})));
  Scenario built_in;
  Scenario from_file;
  ASSERT_TRUE(apply_robot_model("quadruped", SensorLevel::kField, from_file.simulation));
  EXPECT_EQ(config_text(from_file), config_text(built_in));
}

TEST_F(RobotFiles, AnUnknownRobotIsRefusedWithTheNearestOne) {
  const std::string error = error_of({"robot.model=go2_clas"});
  EXPECT_NE(error.find("robot.model: 'go2_clas' is not one of quadruped, go2_class"),
            std::string::npos)
      << error;
  EXPECT_NE(error.find("did you mean 'go2_class'?"), std::string::npos) << error;
  const std::string in_file = error_of({}, "robot: {model: b1}");
  EXPECT_NE(in_file.find("s.yaml:1:16: robot.model: expected one of quadruped"), std::string::npos)
      << in_file;
  EXPECT_NE(error_of({}, "robot: {legs: {shin: 0.2}}").find("unknown key 'robot.legs.shin'"),
            std::string::npos);
  EXPECT_NE(error_of({}, "draw: [{key: robot.model, values: [quadruped, go2_class]}]")
                .find("'robot.model' chooses figures below"),
            std::string::npos);
  SimulationConfig config;
  config.robot.model = "spider";
  const auto refused = Simulation::create(config, 1);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "robot.model: expected one of quadruped, go2_class, inspection_50kg, got 'spider'");
}

/// Whether a scan has returns whose azimuth is within 45 degrees of `centre_deg`.
bool sees(const std::vector<Delivery>& deliveries, double centre_deg) {
  for (const Delivery& each : deliveries) {
    const auto* scan = std::get_if<LidarScanPtr>(&each.measurement);
    if (scan == nullptr) continue;
    for (const LidarPoint& point : (*scan)->points) {
      const double azimuth = std::atan2(point.position.y(), point.position.x());
      const double off =
          std::remainder(azimuth - centre_deg * std::numbers::pi / 180.0, 2.0 * std::numbers::pi);
      if (std::abs(off) < 0.25 * std::numbers::pi) return true;
    }
  }
  return false;
}

TEST_F(RobotFiles, TheHeadMountedLidarIsBlindBehindAndTheOthersAreNot) {
  for (const RobotModel& robot : robot_models()) {
    SCOPED_TRACE(robot.name);
    const auto scenario = load({"robot.model=" + std::string(robot.name), "max_duration=0.25"},
                               "route: {points: [[a, 0, 0], [b, 2, 0]]}");
    ASSERT_TRUE(scenario) << scenario.error().message;
    const Walked walked = walk(*scenario, 1);
    EXPECT_TRUE(sees(walked.deliveries, 0.0));
    EXPECT_TRUE(sees(walked.deliveries, 90.0));
    EXPECT_EQ(sees(walked.deliveries, 180.0), robot.name != "go2_class");
  }
}

}  // namespace
}  // namespace aims
