// SPDX-License-Identifier: BSD-3-Clause
// Every profile of models/datasets on a recording that is laid out as its data set is.
#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/estimate/dataset_profile.hpp"
#include "core/files/tum.hpp"
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

/// The mount of the Ouster in ENWIDE, Newer College and DiTer++.
const Pose kOuster{Eigen::Quaterniond::Identity(), {-0.00625, 0.011775, 0.028535}};

TEST_F(Benchmark, GeodeHasAMatrixAndPositionsAsPoses) {
  Eigen::Matrix3d R;
  R << 0.9999, 0.0049, 0.0153, -0.0050, 1.0000, 0.0021, -0.0153, -0.0022, 0.9999;
  test::DataSet set{"/velodyne_points", "velodyne", "/imu/imu", "imu"};
  set.T_imu_lidar = mount(R, {0.0961, -0.1338, 0.3032});
  set.T_imu_lidar.rotation.normalize();
  sequence(set);
  ASSERT_TRUE(write_tum(data() / "seq_01_gt.txt", truth({0, 0, 0}, false)));
  EXPECT_LT(score_of("geode"), kRight);
}

TEST_F(Benchmark, EnwideIsAnOusterWithAPrismAndACommandContinues) {
  test::DataSet set{"/ouster/points", "os_sensor", "/ouster/imu", "os_imu", CloudLayout::kOuster};
  set.T_imu_lidar = kOuster;
  sequence(set, "tunnel_s");
  std::ofstream csv(data() / "gt_tunnel_s.csv");
  csv << "timestamp,x,y,z\n";
  for (const StampedPose& each : truth({0.05, 0.1, 0.3}, false)) {
    const Eigen::Vector3d& p = each.pose.translation;
    csv << fmt::format("{},{},{},{}\n", each.stamp, p.x(), p.y(), p.z());
  }
  csv.close();
  EXPECT_LT(score_of("enwide", "tunnel_s"), kRight);
  const auto again = aims("benchmark enwide data --estimators lio --no-page --out out");
  EXPECT_NE(again.output.find("0 jobs done, 1 found finished"), std::string::npos) << again.output;
}

TEST_F(Benchmark, NewerCollegeIsAnOusterWithPoses) {
  test::DataSet set{"/os_cloud_node/points", "os_sensor", "/os_cloud_node/imu", "os_imu",
                    CloudLayout::kOuster};
  set.T_imu_lidar = kOuster;
  sequence(set);
  ASSERT_TRUE(write_tum(data() / "seq_01.tum", truth({0, 0, 0}, true)));
  EXPECT_LT(score_of("newer_college"), kRight);
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

TEST_F(Benchmark, LegKiloStampsTheEndOfAScanAndEndsWhereItBegan) {
  test::DataSet set{"/points_raw", "velodyne", "/imu_raw", "imu"};
  set.stamped_at_end = true;
  set.T_imu_lidar = mount(Eigen::Matrix3d::Identity(), {0, 0, 0.20});
  sequence(set, "corridor");
  // The walk comes back to its start.
  const Eigen::Vector3d way =
      walked_->truth.back().pose.translation - walked_->truth.front().pose.translation;
  EXPECT_NEAR(score_of("leg_kilo", "corridor"), way.norm(), kRight);
}

TEST_F(Benchmark, DiterPlusPlusIsAnOusterOnARobot) {
  test::DataSet set{"/agent1/ouster/points", "os_sensor", "/agent1/ouster/imu", "os_imu",
                    CloudLayout::kOuster};
  set.T_imu_lidar = kOuster;
  sequence(set, "lawn_go2_lower_day");
  ASSERT_TRUE(write_tum(data() / "lawn_go2_lower_day.txt", truth({0, 0, 0}, true)));
  EXPECT_LT(score_of("diter_plusplus", "lawn_go2_lower_day"), kRight);
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
  test::DataSet set{"/velodyne_points", "velodyne", "/imu/imu", "imu"};
  sequence(set);
  const auto run = aims("benchmark geode data --estimators lio --no-page --out out");
  EXPECT_NE(run.output.find("no truth: not scored"), std::string::npos) << run.output;
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
