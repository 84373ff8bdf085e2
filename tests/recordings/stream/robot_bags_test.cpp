// SPDX-License-Identifier: BSD-3-Clause
// Bags as drivers of other sensors and robots lay them out, written by python3-rosbag, against what
// went into them. Skipped where python3-rosbag is absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <numbers>
#include <sstream>
#include <tuple>

#include "recordings/stream/recording_reader.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr int kNoPackages = 77;  ///< of make_robot_bags.py
constexpr int kNotFound = 127;   ///< of the shell

struct ExpectedLeg {
  Time stamp = 0;
  Eigen::Vector3d velocity, turning;
  std::array<bool, kLegCount> contact{};
};

struct Expected {
  std::vector<LidarScan> scans;
  std::vector<ExpectedLeg> legs;
};

Expected parse(const std::filesystem::path& file) {
  Expected expected;
  std::ifstream in(file);
  std::string kind;
  while (in >> kind) {
    if (kind == "scan") {
      LidarScan& scan = expected.scans.emplace_back();
      std::size_t size = 0;
      in >> scan.stamp >> scan.end >> size;
      for (std::size_t i = 0; i < size; ++i) {
        LidarPoint& p = scan.points.emplace_back();
        in >> p.position.x() >> p.position.y() >> p.position.z() >> p.intensity >>
            p.time_offset_ns >> p.ring;
      }
    } else {
      ExpectedLeg& leg = expected.legs.emplace_back();
      in >> leg.stamp;
      for (int i = 0; i < 3; ++i) in >> leg.velocity[i];
      for (int i = 0; i < 3; ++i) in >> leg.turning[i];
      for (bool& stands : leg.contact) in >> stands;
    }
  }
  return expected;
}

class RobotBags : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    const std::filesystem::path log = folder_->path() / "log";
    const std::string command = std::string("/usr/bin/python3 ") + AIMS_SOURCE_DIR +
                                "/tests/recordings/stream/make_robot_bags.py " +
                                folder_->path().string() + " >" + log.string() + " 2>&1";
    const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe)
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    std::stringstream said;
    said << std::ifstream(log).rdbuf();
    said_ = said.str();
  }
  static void TearDownTestSuite() { folder_.reset(); }

  void SetUp() override {
    if (exit_code_ == kNotFound) GTEST_SKIP() << "SKIPPED: /usr/bin/python3 is needed";
    if (exit_code_ == kNoPackages) GTEST_SKIP() << said_;
    ASSERT_EQ(exit_code_, 0) << said_;
  }

  void open(const std::string& name, const RecordingConfig& config) {
    auto reader = RecordingReader::open(folder_->path() / (name + ".bag"), config);
    ASSERT_TRUE(reader) << reader.error().message;
    auto read = test::read_all(*reader);
    ASSERT_TRUE(read) << read.error().message;
    deliveries_ = std::move(*read);
    setup_ = reader->setup();
    counts_ = reader->counts();
    expected_ = parse(folder_->path() / (name + ".expected"));
  }

  /// `time_tolerance` [ns] of points and stamps.
  void expect_scans(const std::string& name, Duration time_tolerance,
                    const RecordingConfig& config = {}) {
    open(name, config);
    if (HasFatalFailure()) return;
    const auto scans = test::scans_of(deliveries_);
    ASSERT_EQ(scans.size(), expected_.scans.size());
    for (std::size_t k = 0; k < scans.size(); ++k) {
      const LidarScan& scan = *scans[k];
      const LidarScan& wanted = expected_.scans[k];
      EXPECT_LE(std::abs(scan.stamp - wanted.stamp), time_tolerance);
      EXPECT_LE(std::abs(scan.end - wanted.end), time_tolerance);
      ASSERT_EQ(scan.points.size(), wanted.points.size());
      expect_points(scan, wanted, time_tolerance);
      if (HasFatalFailure()) return;
    }
  }

  static void expect_points(const LidarScan& scan, const LidarScan& wanted, Duration tolerance) {
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const LidarPoint& p = scan.points[i];
      const LidarPoint& w = wanted.points[i];
      ASSERT_EQ(p.position, w.position) << "point " << i;
      ASSERT_EQ(p.ring, w.ring) << "point " << i;
      ASSERT_FLOAT_EQ(p.intensity, w.intensity) << "point " << i;
      const Duration off = scan.stamp - wanted.stamp + p.time_offset_ns - w.time_offset_ns;
      ASSERT_LE(std::abs(off), tolerance) << "point " << i;
    }
  }

  bool noted(const std::string& part) const {
    return std::any_of(
               setup_.notes.begin(), setup_.notes.end(),
               [&](const std::string& note) { return note.find(part) != std::string::npos; }) ||
           std::ranges::any_of(setup_.warnings, [&](const ReadingWarning& each) {
             return each.text.find(part) != std::string::npos;
           });
  }

  static std::unique_ptr<TemporaryFolder> folder_;
  static int exit_code_;
  static std::string said_;
  std::vector<Delivery> deliveries_;
  RecordingSetup setup_;
  std::map<std::string, int> counts_;
  Expected expected_;
};
std::unique_ptr<TemporaryFolder> RobotBags::folder_;
int RobotBags::exit_code_ = 0;
std::string RobotBags::said_;

TEST_F(RobotBags, VelodyneTimesBeforeTheStampMarkItAsTheEnd) {
  expect_scans("velodyne_end", 10);  // float32 seconds near 0.1 hold 7.5 ns
  EXPECT_TRUE(noted("it marks the end of the scan"));
  EXPECT_TRUE(noted("'intensity' up to"));
}

TEST_F(RobotBags, AnyFieldOrderPaddingAndBz2) { expect_scans("padded_bz2", 5); }

TEST_F(RobotBags, BigEndianClouds) { expect_scans("big_endian", 5); }

TEST_F(RobotBags, CloudsOfAMegabyteInLz4Chunks) { expect_scans("big_lz4", 5); }

TEST_F(RobotBags, OusterRowsBecomeFiringOrderWithoutMisses) {
  expect_scans("ouster", 1);
  EXPECT_TRUE(noted("field 't' in ns"));
  EXPECT_TRUE(noted("ring 0 is the highest"));
  EXPECT_GT(counts_["cloud_points_zero"], 0);
  EXPECT_EQ(counts_["cloud_sorted_by_time"], 6);
}

TEST_F(RobotBags, RingsFromTheRowOfAnOrganisedCloudWithPaddedRows) {
  expect_scans("ouster_row_padding", 1);
  EXPECT_TRUE(noted("derived from the row"));
}

TEST_F(RobotBags, DoublesByColumnWithMicroseconds) {
  expect_scans("column_major", 1);
  EXPECT_TRUE(noted("field 'time_offset' in us"));
  EXPECT_TRUE(noted("derived from the column"));
}

TEST_F(RobotBags, HesaiTimesSinceTheEpoch) {
  expect_scans("hesai", 130);  // a double holds 240 ns since 1970
  EXPECT_TRUE(noted("on the clock of the stamps"));
  EXPECT_TRUE(noted("it marks the end of the scan"));
}

TEST_F(RobotBags, PointTimesOnAnotherClockAreRelativeToTheFirst) {
  expect_scans("other_clock", 200);
  EXPECT_TRUE(noted("on another clock"));
}

TEST_F(RobotBags, LivoxCloudWithNanosecondsInDoubles) {
  expect_scans("livox_pointcloud", 300);
  EXPECT_TRUE(noted("field 'timestamp' in ns, on the clock of the stamps"));
}

TEST_F(RobotBags, FloatMilliseconds) {
  expect_scans("milliseconds", 10);
  EXPECT_TRUE(noted("field 't' in ms"));
  EXPECT_TRUE(noted("derived from elevation, 16 rings"));
}

TEST_F(RobotBags, LivoxCustomMessagesAndAnImuInGravities) {
  expect_scans("livox_custom", 300);
  EXPECT_TRUE(noted("IMU in g"));
  for (const ImuSample& sample : test::imu_of(deliveries_)) {
    ASSERT_NEAR(sample.specific_force.z(), 9.80665, 1e-12);
  }
}

/// Times to within the rings' share of a column, which azimuth does not tell.
TEST_F(RobotBags, BarePointsGetRingAndTimeFromTheirDirection) {
  open("bare", {});
  EXPECT_TRUE(noted("derived from azimuth, spinning clockwise"));
  EXPECT_TRUE(noted("derived from elevation, 16 rings"));
  const auto scans = test::scans_of(deliveries_);
  ASSERT_EQ(scans.size(), expected_.scans.size());
  const auto by_place = [](const LidarPoint& a, const LidarPoint& b) {
    return std::tuple(a.position.x(), a.position.y(), a.position.z()) <
           std::tuple(b.position.x(), b.position.y(), b.position.z());
  };
  for (std::size_t k = 0; k < scans.size(); ++k) {
    LidarScan scan = *scans[k];
    EXPECT_EQ(scan.stamp, expected_.scans[k].stamp);
    EXPECT_EQ(scan.end, expected_.scans[k].end);
    std::sort(scan.points.begin(), scan.points.end(), by_place);
    LidarScan& wanted = expected_.scans[k];
    std::sort(wanted.points.begin(), wanted.points.end(), by_place);
    ASSERT_EQ(scan.points.size(), wanted.points.size());
    expect_points(scan, wanted, 600'000);
  }
}

TEST_F(RobotBags, JointsAndContactsGiveLegOdometry) {
  RecordingConfig config;
  config.topics.lidar = "none";
  open("joints_and_contacts", config);
  const auto legs = test::legs_of(deliveries_);
  ASSERT_EQ(legs.size(), expected_.legs.size());
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const ExpectedLeg& wanted = expected_.legs[k];
    ASSERT_EQ(legs[k].stamp, wanted.stamp);
    ASSERT_EQ(legs[k].contact, wanted.contact);
    ASSERT_LT((legs[k].linear_velocity - wanted.velocity).norm(), 1e-7);
    ASSERT_LT((legs[k].angular_velocity - wanted.turning).norm(), 1e-12);
  }
  // The pose goes round as the twist says: 0.745 s at 0.3 rad/s.
  EXPECT_NEAR(yaw_of(legs.back().T_odom_base.rotation), 0.3 * 0.745, 1e-3);
  EXPECT_NEAR(setup_.leg_rate_hz.value_or(0.0), 200.0, 1e-6);
  EXPECT_TRUE(noted("by leg kinematics"));
}

TEST_F(RobotBags, ATwistIsIntegratedAndExtrinsicsFollowTheChain) {
  open("twist", {});
  const auto legs = test::legs_of(deliveries_);
  ASSERT_EQ(legs.size(), expected_.legs.size());
  for (std::size_t k = 0; k < legs.size(); ++k) {
    ASSERT_EQ(legs[k].stamp, expected_.legs[k].stamp);
    ASSERT_EQ(legs[k].linear_velocity, expected_.legs[k].velocity);
    const double t = to_seconds(legs[k].stamp - legs.front().stamp);
    const Eigen::Vector3d arc(0.8 * std::sin(0.5 * t), 0.8 * (1.0 - std::cos(0.5 * t)), 0.0);
    ASSERT_LT((legs[k].T_odom_base.translation - arc).norm(), 2e-3) << t;
  }
  EXPECT_TRUE(noted("a twist without a pose"));
  const SensorRig& rig = setup_.rig;
  EXPECT_LT((rig.T_body_base.translation - Eigen::Vector3d(0.0, 0.0, -0.1)).norm(), 1e-12);
  EXPECT_NEAR(yaw_of(rig.T_body_base.rotation), -std::numbers::pi / 2.0, 1e-12);
  EXPECT_LT((rig.T_body_lidar.translation - Eigen::Vector3d(0.0, -0.3, 0.1)).norm(), 1e-12);
  EXPECT_NEAR(rig.T_body_lidar.rotation.norm(), 1.0, 1e-12);
}

TEST_F(RobotBags, ConfiguredExtrinsicsOverrideTf) {
  RecordingConfig config;
  config.T_imu_lidar.override_tf = true;
  config.T_imu_lidar.translation = {1.0, 2.0, 3.0};
  config.T_imu_lidar.rotation_rpy_deg = {0.0, 0.0, 90.0};
  open("twist", config);
  EXPECT_EQ(setup_.rig.T_body_lidar.translation, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR(yaw_of(setup_.rig.T_body_lidar.rotation), std::numbers::pi / 2.0, 1e-12);
}

}  // namespace
}  // namespace aims
