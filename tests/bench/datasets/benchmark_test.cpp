// SPDX-License-Identifier: BSD-3-Clause
// Every profile of models/datasets on a recording that is laid out as its data set is.
#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/estimate/dataset_profile.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/tum.hpp"
#include "core/text.hpp"
#include "tests/bench/datasets/data_sets.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Pose mount(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  return {Eigen::Quaterniond(R), t};
}

class Benchmark : public testing::CommandLine {
 protected:
  static void SetUpTestSuite() {
    walk_folder_ = std::make_unique<TemporaryFolder>();
    walked_ = std::make_unique<test::Walked>(test::walk_of(walk_folder_->path(), 4.0));
  }
  static void TearDownTestSuite() {
    walked_.reset();
    walk_folder_.reset();
  }

  fs::path data() const { return folder_.path() / "data"; }

  void SetUp() override { fs::create_directories(data()); }

  /// Truth of the point in the data set's epoch; `every`: as control points.
  Trajectory truth(const Eigen::Vector3d& point, bool attitude, std::size_t every = 1) const {
    Trajectory moved;
    for (std::size_t i = 0; i < walked_->truth.size(); i += every) {
      StampedPose each = walked_->truth[i];
      each.stamp += test::kDataEpoch;
      each.pose.translation = each.pose * point;
      if (!attitude) each.pose.rotation.setIdentity();
      moved.push_back(each);
    }
    return moved;
  }

  /// The same of a body in the IMU frame.
  Trajectory truth_of(const Pose& T_imu_body) const {
    Trajectory moved = truth({0, 0, 0}, true);
    for (StampedPose& each : moved) each.pose = each.pose * T_imu_body;
    return moved;
  }

  void sequence(const test::DataSet& set, const std::string& name = "seq_01",
                const Eigen::Vector3d& prism = Eigen::Vector3d::Zero()) const {
    test::write_sequence(*walked_, set, name, prism, data());
  }

  /// Runs the benchmark by `lio`; the score of the sequence.
  double score_of(const std::string& profile, const std::string& name = "seq_01",
                  const std::string& more = "") const {
    const auto run = aims("benchmark " + profile +
                          " data --estimators lio --no-page --out out --jobs 1 " + more);
    EXPECT_EQ(run.exit_code, 0) << run.output;
    const Json all = results();
    for (const Json& each : all["sequences"]) {
      if (each["name"] == name && each["ours"]["lio"].is_number()) {
        return each["ours"]["lio"].get<double>();
      }
    }
    ADD_FAILURE() << run.output;
    return -1.0;
  }

  Json results() const {
    std::ifstream file(folder_.path() / "out" / "benchmark.json");
    return Json::parse(file, nullptr, false);
  }

  static std::unique_ptr<TemporaryFolder> walk_folder_;
  static std::unique_ptr<test::Walked> walked_;
};

std::unique_ptr<TemporaryFolder> Benchmark::walk_folder_;
std::unique_ptr<test::Walked> Benchmark::walked_;

/// Of an ATE; lio on the walk errs by 2 cm. A mirrored, turned or ignored mount errs by more.
constexpr double kRight = 0.06;  ///< [m]

/// The mount of the Ouster in ENWIDE and DiTer++.
const Pose kOuster{Eigen::Quaterniond::Identity(), {-0.00625, 0.011775, 0.028535}};

/// The devices of GEODE, by cali/*.yaml.
test::DataSet geode_device(const std::string& device) {
  Eigen::Matrix3d R;
  test::DataSet set{"/velodyne_points", "velodyne", "/imu/data", "imu"};
  if (device == "alpha") {
    R << 0.9999, 0.0049, 0.0153, -0.0050, 1.0000, 0.0021, -0.0153, -0.0022, 0.9999;
    set.T_imu_lidar = mount(R, {0.0961, -0.1338, 0.3032});
  } else if (device == "beta") {
    R << 0.998638, 0.052001, -0.004278, -0.051937, 0.998554, 0.013900, 0.004994, -0.013659,
        0.999894;
    set = {"/ouster/points", "os_sensor", "/imu/data", "imu", CloudLayout::kOuster};
    set.T_imu_lidar = mount(R, {-0.027172, -0.034873, 0.062643});
  } else {
    R << 0.999620, 0.027463, 0.002445, -0.027517, 0.999299, 0.025398, -0.001746, -0.025456,
        0.999674;
    set = {"/livox/lidar", "livox_frame", "/imu/data", "imu"};
    set.custom_message = true;
    set.T_imu_lidar = mount(R, {0.049258, -0.012500, 0.026946});
  }
  set.T_imu_lidar.rotation.normalize();
  return set;
}

/// What its scripts move the poses of the LiDAR by: T_eval = T_device T^-1.
Pose geode_script(double qw, double qx, double qy, double qz, const Eigen::Vector3d& t) {
  return {Eigen::Quaterniond(qw, qx, qy, qz).normalized(), t};
}

TEST_F(Benchmark, GeodeHasTheTruthOfTheLidarOfItsDevice) {
  const test::DataSet alpha = geode_device("alpha");
  sequence(alpha);
  ASSERT_TRUE(write_tum(data() / "seq_01_gt.txt", truth(alpha.T_imu_lidar.translation, false)));
  EXPECT_LT(score_of("geode"), kRight);
}

TEST_F(Benchmark, GeodeHasTheTruthOfAnotherDeviceOnItsRack) {
  struct Rack {
    const char *profile, *device, *sequence, *truth;
    Pose T;
  };
  const Rack racks[] = {
      {"geode", "alpha", "Offroad1_alpha", "Offroad1.txt",
       geode_script(0.9999909, -0.0009, -0.00355, 0.0022, {0.0090, -0.2925, 0.4533})},
      {"geode_gamma", "gamma", "Inland_Waterways_Short_Gamma", "Inland_Waterways_Short_gt.txt",
       geode_script(0.9998828, -0.0057758, 0.0022253, 0.0140019, {0.0305, -0.5959, 0.0902})},
      {"geode_beta", "beta", "Tunneling_tunnel1_beta", "Tunneling_tunnel1.txt",
       geode_script(0.999991, 0.000903519, 0.0035434, -0.00220342,
                    {-0.0108864, 0.293397, -0.452674})},
      {"geode_gamma", "gamma", "Shield_tunnel1_gamma", "Shield_tunnel1.txt",
       geode_script(0.999901, -0.00492765, 0.00575961, 0.0117651,
                    {0.00947221, -0.308202, -0.365733})}};
  for (const Rack& each : racks) {
    const test::DataSet set = geode_device(each.device);
    sequence(set, each.sequence);
    const Pose T_imu_truth = set.T_imu_lidar * each.T.inverse();
    ASSERT_TRUE(write_tum(data() / each.truth, truth(T_imu_truth.translation, false)));
    EXPECT_LT(score_of(each.profile, each.sequence), kRight) << each.sequence;
    fs::remove_all(data());
    fs::remove_all(folder_.path() / "out");
    fs::create_directories(data());
  }
}

TEST_F(Benchmark, EnwideIsAnOusterWithAPrismAndACommandContinues) {
  test::DataSet set{"/ouster/points", "os_sensor", "/ouster/imu", "os_imu", CloudLayout::kOuster};
  set.T_imu_lidar = kOuster;
  sequence(set, "tunnel_s");
  std::ofstream csv(data() / "gt_tunnel_s.csv");
  csv << "timestamp x y z qx qy qz qw\n";
  for (const StampedPose& each : truth({0.05, 0.1, 0.3}, false)) {
    const Eigen::Vector3d& p = each.pose.translation;
    csv << fmt::format("{} {} {} {} 0 0 0 1\n", stamp_text(each.stamp), p.x(), p.y(), p.z());
  }
  csv.close();
  EXPECT_LT(score_of("enwide", "tunnel_s"), kRight);
  const auto again = aims("benchmark enwide data --estimators lio --no-page --out out");
  EXPECT_NE(again.output.find("0 jobs done, 1 found finished"), std::string::npos) << again.output;
}

/// By os_imu_lidar_transforms.yaml of Newer College, 2021: LiDAR and base in the IMU.
const Eigen::Quaterniond kNewerCollegeTurn =
    Eigen::Quaterniond(0.99998, 0.0032925, -0.004627, -0.0024302).normalized();
const Pose kNewerCollege{kNewerCollegeTurn, {0.013801, -0.012207, -0.01514}};
const Pose kNewerCollegeBase{kNewerCollegeTurn, {0.013642, -0.011607, -0.10583}};

TEST_F(Benchmark, NewerCollegeIsAnOusterWithPoses) {
  test::DataSet set{"/os_cloud_node/points", "os_sensor", "/os_cloud_node/imu", "os_imu",
                    CloudLayout::kOuster};
  set.T_imu_lidar = kNewerCollege;
  sequence(set);
  ASSERT_TRUE(write_tum(data() / "seq_01.tum", truth_of(kNewerCollegeBase)));
  EXPECT_LT(score_of("newer_college"), kRight);
}

TEST_F(Benchmark, NewerCollegeInOneFolderHasTheTruthOfEachSequenceByItsName) {
  test::DataSet set{"/os_cloud_node/points", "os_sensor", "/os_cloud_node/imu", "os_imu",
                    CloudLayout::kOuster};
  set.T_imu_lidar = kNewerCollege;
  for (const char* name : {"quad-easy", "math-hard"}) {
    sequence(set, std::string("2021-07-01-10-37-38-") + name);
  }
  std::ofstream csv(data() / "gt-nc-quad-easy.csv");
  csv << "#sec,nsec,x,y,z,qx,qy,qz,qw\n";
  for (const StampedPose& each : truth_of(kNewerCollegeBase)) {
    const Eigen::Vector3d& p = each.pose.translation;
    const Eigen::Quaterniond& q = each.pose.rotation;
    csv << fmt::format("{},{},{},{},{},{},{},{},{}\n", each.stamp / kSecond, each.stamp % kSecond,
                       p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  csv.close();
  EXPECT_LT(score_of("newer_college", "2021-07-01-10-37-38-quad-easy"), kRight);
  const Json all = results();
  EXPECT_TRUE(all["sequences"][0]["ours"]["lio"].is_null()) << "math-hard has no truth";
}

TEST_F(Benchmark, NewerCollege2020HasSecondsAndNanosecondsOfItsCamera) {
  test::DataSet set{"/os1_cloud_node/points", "os1_lidar", "/os1_cloud_node/imu", "os1_imu",
                    CloudLayout::kOuster};
  set.T_imu_lidar = {Eigen::Quaterniond(0, 0, 0, 1), {-0.006253, 0.011775, 0.028535}};
  set.bag_per_topic = true;
  sequence(set, "quad_with_dynamics");
  const Pose T_imu_camera{Eigen::Quaterniond(0.92388, 0, 0, 0.38268),
                          {0.035643, 0.089026, -0.021653}};
  std::ofstream csv(data() / "quad_with_dynamics" / "registered_poses.csv");
  csv << "#sec,nsec,x,y,z,qx,qy,qz,qw\n";
  for (const StampedPose& each : truth_of(T_imu_camera)) {
    const Eigen::Vector3d& p = each.pose.translation;
    const Eigen::Quaterniond& q = each.pose.rotation;
    csv << fmt::format("{},{},{},{},{},{},{},{},{}\n", each.stamp / kSecond, each.stamp % kSecond,
                       p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  csv.close();
  EXPECT_LT(score_of("newer_college20", "quad_with_dynamics"), kRight);
}

TEST_F(Benchmark, OxfordSpiresIsARosbag2WithPosesOfItsBase) {
  test::DataSet set{"/hesai/pandar", "hesai", "/alphasense_driver_ros/imu", "imu",
                    CloudLayout::kHesai};
  // config/sensor.yaml: T_cam_imu and T_cam_lidar of cam_front, T_base_lidar.
  const Pose T_cam_lidar{Eigen::Quaterniond(0.5013981452864594, 0.5034725628949727,
                                            0.5003337192107279, -0.4947539264483171),
                         {0.00035060884033447846, -0.079574053851818, -0.053826061545697405}};
  const Pose T_cam_imu{Eigen::Quaterniond(0.0018188239395917287, 0.0067828148322833575,
                                          -0.7111602175046777, 0.7029949006508702),
                       {-0.004591628876843622, -0.002003031393103538, -0.05479917787120936}};
  const Pose T_base_lidar{Eigen::Quaterniond(0, 0, 0, 1), {0.0, 0.0, 0.124}};
  set.T_imu_lidar = T_cam_imu.inverse() * T_cam_lidar;
  sequence(set, "ros1");
  const auto converted = aims("convert data/ros1.bag --quiet -o data/keble_college_02/");
  ASSERT_EQ(converted.exit_code, 0) << converted.output;
  fs::remove(data() / "ros1.bag");
  ASSERT_TRUE(write_tum(data() / "keble_college_02" / "gt-tum.txt",
                        truth_of(set.T_imu_lidar * T_base_lidar.inverse())));
  EXPECT_LT(score_of("oxford_spires", "keble_college_02"), kRight);
}

TEST_F(Benchmark, BotanicGardenHasPosesOfItsLidarInTheBag) {
  Eigen::Matrix3d R;
  R << 0.999678872580465, 0.0252865664429322, 0.00150422292234868, -0.0252723438960774,
      0.999649431893338, -0.0078025434141585, -0.00170103929405540, 0.00776298237926191,
      0.99996789371916;
  test::DataSet set{"/velodyne_points", "velodyne", "/imu/data", "imu"};
  set.T_imu_lidar = mount(R, {0.0584867781527745, 0.00840419966766332, 0.168915521980526});
  set.T_imu_lidar.rotation.normalize();
  sequence(set, "1018_00");
  ASSERT_TRUE(write_tum(data() / "1018_00_GT_output.txt", truth_of(set.T_imu_lidar)));
  EXPECT_LT(score_of("botanic_garden", "1018_00"), kRight);
  EXPECT_EQ(results()["sequences"][0]["published"]["LOAM"], 0.523);
}

TEST_F(Benchmark, Hilti2023HasItsOwnClassesOfPoints) {
  Eigen::Matrix3d R;
  R << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  test::DataSet set{"/hesai/pandar", "PandarXT-32", "/alphasense/imu", "imu_sensor_frame",
                    CloudLayout::kHesai};
  set.T_imu_lidar = mount(R, {-0.001, -0.00855, 0.055});
  sequence(set, "site1_handheld_1");
  fs::create_directories(data() / "groundtruth_2023");
  ASSERT_TRUE(write_tum(data() / "groundtruth_2023" / "site1_handheld_1.txt",
                        truth({0.059, -0.00855, 0.1964}, false, 300)));
  const double score = score_of("hilti23", "site1_handheld_1");
  EXPECT_GE(score, 25.0) << "5 of 20 for points below 6 cm";
  EXPECT_LE(score, 100.0);
}

TEST_F(Benchmark, Hilti2023RobotMeasuresControlPointsWithItsLidar) {
  Eigen::Matrix4d T_lidar_imu;
  T_lidar_imu << 0.9993809082422996, -0.003397272928783347, 0.03501797791768812,
      -0.13406141062872667, -0.0036988105559615262, -0.9999566093030182, 0.008549755065630918,
      -0.010899820828818012, 0.03498741261178718, -0.0086739868491098, -0.9993501102771111,
      0.006109253103427932, 0, 0, 0, 1;
  const Eigen::Matrix4d T = T_lidar_imu.inverse();
  test::DataSet set{"/rslidar_points", "rslidar", "/imu/data", "imu", CloudLayout::kHesai};
  set.T_imu_lidar = mount(T.topLeftCorner<3, 3>(), T.topRightCorner<3, 1>());
  set.T_imu_lidar.rotation.normalize();
  sequence(set, "site2_robot_1");
  fs::create_directories(data() / "groundtruth_2023");
  Trajectory surveyed, measured;
  for (std::size_t i = 0; i < walked_->truth.size(); i += 300) {
    const Time stamp = walked_->truth[i].stamp + test::kDataEpoch;
    const Eigen::Vector3d in_lidar(-0.8 - 0.05 * static_cast<double>(i % 700) / 100.0,
                                   i % 2 == 0 ? 0.2 : -1.1, 0.3);
    measured.push_back({stamp, {Eigen::Quaterniond::Identity(), in_lidar}});
    const Eigen::Vector3d point = walked_->truth[i].pose * (set.T_imu_lidar * in_lidar);
    surveyed.push_back({stamp, {Eigen::Quaterniond::Identity(), point}});
  }
  ASSERT_TRUE(write_tum(data() / "groundtruth_2023" / "site2_robot_1.txt", surveyed));
  ASSERT_TRUE(write_tum(data() / "groundtruth_2023" / "site2_robot_1_lidar.txt", measured));
  EXPECT_GE(score_of("hilti23_robot", "site2_robot_1"), 25.0) << "5 of 20 below 6 cm";
}

TEST_F(Benchmark, NtnuTunnelsArePacketsOfAnOusterWithMetadata) {
  test::write_ouster_packets(data() / "tunnel.bag", 30);
  // It stands.
  Trajectory still;
  for (int i = 0; i <= 30; ++i) still.push_back({test::kDataEpoch + i * kSecond / 10, Pose()});
  ASSERT_TRUE(write_tum(data() / "tunnel.tum", still));
  EXPECT_LT(score_of("ntnu_tunnels", "tunnel"), 0.01);
}

TEST_F(Benchmark, Hilti2022HasControlPointsOfItsTip) {
  Eigen::Matrix3d R;
  R << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  test::DataSet set{"/hesai/pandar", "PandarXT-32", "/alphasense/imu", "imu_sensor_frame",
                    CloudLayout::kHesai};
  set.T_imu_lidar = mount(R, {-0.001, -0.00855, 0.055});
  sequence(set, "exp07_long_corridor");
  fs::create_directories(data() / "groundtruth_2022");
  ASSERT_TRUE(write_tum(data() / "groundtruth_2022" / "exp07_long_corridor.txt",
                        truth({0.059, -0.00855, 0.1964}, false, 300)));
  const double score = score_of("hilti22", "exp07_long_corridor");
  EXPECT_GT(score, 30.0) << "points below 6 cm";
  EXPECT_LE(score, 100.0);
}

TEST_F(Benchmark, Hilti2022HasPosesOfItsImuWithoutTheLeverArm) {
  Eigen::Matrix3d R;
  R << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  test::DataSet set{"/hesai/pandar", "PandarXT-32", "/alphasense/imu", "imu_sensor_frame",
                    CloudLayout::kHesai};
  set.T_imu_lidar = mount(R, {-0.001, -0.00855, 0.055});
  sequence(set, "exp04_construction_upper_level");
  ASSERT_TRUE(
      write_tum(data() / "exp_04_construction_upper_level_imu.txt", truth({0, 0, 0}, true)));
  EXPECT_LT(score_of("hilti22_imu", "exp04_construction_upper_level"), kRight);
  EXPECT_EQ(results()["unit"], "m");
}

TEST_F(Benchmark, LegKiloStampsTheEndOfAScanAndEndsWhereItBegan) {
  test::DataSet set{"/points_raw", "velodyne", "/imu_raw", "imu"};
  set.stamped_at_end = true;
  set.T_imu_lidar = mount(Eigen::Matrix3d::Identity(), {0, 0, 0.20});
  sequence(set, "corridor");
  // The walk comes back to its start.
  const Eigen::Vector3d way =
      walked_->truth.back().pose.translation - walked_->truth.front().pose.translation;
  EXPECT_NEAR(score_of("leg_kilo", "corridor"), way.norm(), kRight);
  std::ifstream file(folder_.path() / "out" / "suite.json");
  const Json scores =
      Json::parse(file)["scenarios"][0]["estimators"]["lio"]["scores"];  // of the end alone
  EXPECT_TRUE(scores["m_end_m"]["median"].is_number());
  EXPECT_FALSE(scores.contains("control_points.score"));
  for (const char* of_the_way : {"ate_yaw_m", "ate_m", "ate_se3_m", "max_error_z_m", "success"}) {
    if (scores.contains(of_the_way)) {
      EXPECT_TRUE(scores[of_the_way]["median"].is_null()) << of_the_way;
    }
  }
}

TEST_F(Benchmark, NotesNameAllSequencesOfWhichTheyAreAndTheScoreGoesFirst) {
  test::DataSet set{"/points_raw", "velodyne", "/imu_raw", "imu"};
  set.stamped_at_end = true;
  set.T_imu_lidar = mount(Eigen::Matrix3d::Identity(), {0, 0, 0.20});
  sequence(set, "corridor");
  sequence(set, "park");
  ASSERT_TRUE(write_tum(data() / "park.txt", truth({0, 0, 0}, true)));
  const auto run = aims("benchmark leg_kilo data --estimators lio --no-page --out out");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(run.output.find("Leg-KILO data set, score m_end_m [m]: "), 0U) << run.output;
  for (const char* note : {"corridor, park: LiDAR in the IMU frame: [0.0000, 0.0000, 0.2000] m",
                           "park: truth: park.txt", "corridor: truth: the pose of the end",
                           "park: the truth is taken to be of the IMU"}) {
    EXPECT_NE(run.output.find(note), std::string::npos) << note << "\n" << run.output;
  }
  const auto suite = read_file(folder_.path() / "out" / "suite.md");
  ASSERT_TRUE(suite);
  const std::size_t first = suite->find("\n## ");
  EXPECT_EQ(suite->find("\n## M_end"), first) << *suite;
}

TEST_F(Benchmark, LegKiloHasTheLegsOfAHighState) {
  test::DataSet set{"/points_raw", "velodyne", "/imu_raw", "imu"};
  set.stamped_at_end = set.high_state = true;
  set.T_imu_lidar = mount(Eigen::Matrix3d::Identity(), {0, 0, 0.20});
  sequence(set, "corridor");
  const auto run =
      aims("benchmark leg_kilo data --estimators leg,aims_d --no-page --out out --jobs 1");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const double way =
      (walked_->truth.back().pose.translation - walked_->truth.front().pose.translation).norm();
  const Json ours = results()["sequences"][0]["ours"];
  EXPECT_NEAR(ours["leg"].get<double>(), way, 0.3) << "of 8 m, by legs and gyro alone";
  EXPECT_NEAR(ours["aims_d"].get<double>(), way, kRight);
  EXPECT_NE(run.output.find("repetitions are left out"), std::string::npos) << run.output;
}

TEST_F(Benchmark, LegKiloHasNoEndForOtherRoutes) {
  test::DataSet set{"/points_raw", "velodyne", "/imu_raw", "imu"};
  set.stamped_at_end = true;
  set.T_imu_lidar = mount(Eigen::Matrix3d::Identity(), {0, 0, 0.20});
  sequence(set, "park");
  const auto run = aims("benchmark leg_kilo data --estimators lio --no-page --out out --jobs 1");
  EXPECT_NE(run.output.find("park: not scored: no truth: looked for park.txt"), std::string::npos)
      << run.output;
}

TEST_F(Benchmark, DiterPlusPlusIsAnOusterOnARobot) {
  test::DataSet set{"/agent1/ouster/points", "os_sensor", "/agent1/ouster/imu", "os_imu",
                    CloudLayout::kOuster};
  set.T_imu_lidar = kOuster;
  sequence(set, "lawn_go2_lower_day");
  ASSERT_TRUE(write_tum(data() / "lawn_go2_lower_day.txt", truth({0, 0, 0}, true)));
  EXPECT_LT(score_of("diter_plusplus", "lawn_go2_lower_day"), kRight);
}

TEST_F(Benchmark, DiterPlusPlusHasLegsBelowTheImuOfItsOuster) {
  test::DataSet set{"/agent1/ouster/points", "os_sensor", "/agent1/ouster/imu", "os_imu",
                    CloudLayout::kOuster};
  set.T_imu_lidar = kOuster;
  set.high_state = true;
  sequence(set, "lawn_go2_lower_day");
  const auto run = aims("benchmark diter_plusplus data --estimators lio --no-page --out out");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_NE(run.output.find("base in the IMU frame: [-0.0112, 0.0112, -0.2705] m"),
            std::string::npos)
      << run.output;
  EXPECT_EQ(run.output.find("NO TRANSFORM"), std::string::npos) << run.output;
}

TEST_F(Benchmark, M3dgrIsALivoxOfCustomMessages) {
  test::DataSet set{"/livox/mid360/lidar", "livox_frame", "/livox/mid360/imu", "livox_frame"};
  set.custom_message = true;
  set.T_imu_lidar = mount(Eigen::Matrix3d::Identity(), {-0.011, -0.02329, 0.04412});
  sequence(set, "Dynamic01");
  ASSERT_TRUE(write_tum(data() / "GTDynamic01.txt", truth({0, 0, 0}, true)));
  EXPECT_LT(score_of("m3dgr", "Dynamic01"), kRight);
}

TEST_F(Benchmark, GrandTourHasABagPerTopicAndAPrismOnATopic) {
  Eigen::Matrix3d R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  test::DataSet set{"/boxi/hesai/points", "hesai_lidar", "/boxi/adis/imu", "adis16475_imu",
                    CloudLayout::kHesai};
  set.has_tf = set.bag_per_topic = true;
  set.T_imu_lidar = mount(R, {0.05, 0.02, 0.1});
  set.prism_topic = "/boxi/ap20/prism_position";
  set.odometry_topic = "/anymal/state_estimator/odometry";
  sequence(set, "2024-10-01-11-29-55", {0.1, -0.05, 0.3});
  EXPECT_LT(score_of("grandtour", "2024-10-01-11-29-55"), kRight);
}

TEST_F(Benchmark, IilabsPutsPublishedScoresBeside) {
  test::DataSet set{"/eve/lidar3d", "lidar3d", "/eve/imu/data", "imu"};
  set.has_tf = set.bag_per_topic = true;
  set.T_imu_lidar = mount(Eigen::Matrix3d::Identity(), {0.1, 0, 0.2});
  sequence(set, "nav_a_diff");
  ASSERT_TRUE(write_tum(data() / "nav_a_diff" / "ground_truth.tum", truth({0, 0, 0}, true)));
  EXPECT_LT(score_of("iilabs3d", "nav_a_diff"), kRight);
  const Json published = results()["sequences"][0]["published"];
  EXPECT_EQ(published["LIORF"], 0.030);
  EXPECT_EQ(published["GLIM"], 0.525);
  std::ifstream markdown(folder_.path() / "out" / "benchmark.md");
  const std::string text{std::istreambuf_iterator<char>(markdown), {}};
  EXPECT_NE(text.find("LIORF (published)"), std::string::npos) << text;
}

TEST_F(Benchmark, InfoFindsAWrongMountOfALidarWithoutRings) {
  test::DataSet set{"/livox/lidar", "livox_frame", "/livox/imu", "livox_frame"};
  set.custom_message = true;
  sequence(set, "livox");
  const auto right = aims("info --mount data/livox.bag");
  EXPECT_NE(right.output.find("no contradiction between LiDAR odometry and gyro"),
            std::string::npos)
      << right.output;
  const auto turned = aims(
      "info --mount data/livox.bag --set "
      "recording.T_imu_lidar.quaternion_xyzw=[0,0,0.7071,0.7071]");
  EXPECT_NE(turned.output.find("MOUNT OF THE LIDAR: LiDAR odometry and gyro contradict it"),
            std::string::npos)
      << turned.output;
}

TEST_F(Benchmark, InfoFindsAWrongMountByTheRotationOfLidarOdometry) {
  const std::string bag = "'" + (walk_folder_->path() / "walk.bag").string() + "'";
  const auto right = aims("info --mount " + bag);
  EXPECT_NE(right.output.find("no contradiction between LiDAR odometry and gyro"),
            std::string::npos)
      << right.output;
  const auto upside_down =
      aims("info --mount " + bag + " --set recording.T_imu_lidar.quaternion_xyzw=[1,0,0,0]");
  EXPECT_NE(upside_down.output.find("MOUNT OF THE LIDAR: LiDAR odometry and gyro contradict it"),
            std::string::npos)
      << upside_down.output;
  EXPECT_NE(upside_down.output.find("to try it: --set recording.T_imu_lidar.quaternion_xyzw="),
            std::string::npos);
}

/// The delay that `aims info --mount` advises [s]; 0 for none.
double advised_delay(const std::string& output) {
  const std::string key = "to try it: --set recording.lidar_delay=";
  const std::size_t at = output.find(key);
  return at == std::string::npos ? 0.0 : std::stod(output.substr(at + key.size()));
}

TEST_F(Benchmark, InfoFindsAClockByTheTurnRateOfLidarOdometry) {
  const std::string bag = "'" + (walk_folder_->path() / "walk.bag").string() + "'";
  const auto right = aims("info --mount " + bag);
  EXPECT_NE(right.output.find("clock of the LiDAR: within 20 ms of the IMU's"), std::string::npos)
      << right.output;
  // Moved by 0.1 s either way: the advice is what takes that back.
  for (const char* moved : {"0.1", "-0.1"}) {
    const auto wrong = aims("info --mount " + bag + " --set recording.lidar_delay=" + moved);
    EXPECT_NE(wrong.output.find("CLOCK OF THE LIDAR: stamped"), std::string::npos) << wrong.output;
    EXPECT_NEAR(advised_delay(wrong.output), 0.0, 0.02) << wrong.output;
  }
}

TEST_F(Benchmark, WhatIsMissingIsSaid) {
  const auto none = aims("benchmark geode data");
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.output.find("data: expected recordings"), std::string::npos) << none.output;
  const auto wrong = aims("benchmark geod data");
  EXPECT_NE(wrong.output.find("did you mean 'geode'?"), std::string::npos) << wrong.output;
  const test::DataSet set = geode_device("alpha");
  sequence(set);
  const auto run = aims("benchmark geode data --estimators lio --no-page --out out");
  EXPECT_NE(run.output.find("seq_01 will not be scored: no truth: looked for seq_01_gt.txt"),
            std::string::npos)
      << run.output;
  EXPECT_NE(run.output.find("seq_01: not scored: no truth"), std::string::npos) << run.output;
}

TEST(DatasetProfiles, LoadAndNameTheirSources) {
  const auto files = dataset_profiles(AIMS_SOURCE_DIR "/models/datasets");
  EXPECT_GE(files.size(), 9U);
  for (const fs::path& file : files) {
    const auto profile = load_dataset_profile(file, {});
    ASSERT_TRUE(profile) << profile.error().message;
    for (const std::string& text : {profile->title, profile->citation, profile->url,
                                    profile->licence, profile->tested, profile->score_text}) {
      EXPECT_FALSE(text.empty()) << file;
    }
    EXPECT_EQ(profile->published.empty(), profile->published_source.empty()) << file;
    EXPECT_EQ(profile->read.recording.topics.truth, "none") << file;
  }
}

}  // namespace
}  // namespace aims
