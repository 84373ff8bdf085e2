// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "core/random.hpp"
#include "recordings/clouds/point_cloud.hpp"
#include "recordings/clouds/scan_period.hpp"
#include "recordings/frames/frame_tree.hpp"
#include "recordings/legs/leg_names.hpp"
#include "recordings/recording_config.hpp"
#include "recordings/stream/latency_changes.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"

namespace aims {
namespace {

TEST(ScanPeriod, IsTheMostFrequentSpacingDespiteLosses) {
  EXPECT_EQ(scan_period({0, 100, 200, 500, 600, 900}, std::nullopt), 100);
  // Every gap is of several scans; how long points fire tells of how many.
  EXPECT_EQ(scan_period({0, 300, 500, 900}, 99), 100);
}

TEST(ScanPeriod, IsTheNearestRateForJitteringStamps) {
  RandomStream random(3, "test");
  std::vector<Time> stamps;
  for (int k = 0; k < 40; ++k) {
    stamps.push_back(k * 50 * kMillisecond + std::llround(random.uniform(-1e6, 1e6)));
  }
  EXPECT_EQ(scan_period(stamps, std::nullopt), 50 * kMillisecond);
  EXPECT_EQ(scan_period(stamps, 49 * kMillisecond), 50 * kMillisecond);
}

TEST(ScanPeriod, OfOneCloudIsTheRateNearestToItsSpan) {
  EXPECT_EQ(scan_period({5, 5}, 99'944'448), 100 * kMillisecond);
  EXPECT_EQ(scan_period({5}, std::nullopt), std::nullopt);
  EXPECT_EQ(scan_period({}, std::nullopt), std::nullopt);
}

TEST(LatencyTrend, GrowsByTheSecondsThatPassAndTellsNothingOfNone) {
  LatencyTrend lidar, imu;
  EXPECT_EQ(lidar.step(imu), std::nullopt);
  EXPECT_EQ(lidar.growth(imu), std::nullopt);
  for (int second = 0; second < 120; second += 4) {  // the others are missing
    lidar.add(second * kSecond, 0);
    imu.add(second * kSecond, second * 10 * kMillisecond);
  }
  EXPECT_NEAR(imu.growth(lidar).value_or(0.0), 0.01, 1e-9);
}

TEST(ScanPeriod, OfALidarThatIsBlindBehindIsLongerThanItsSpan) {
  constexpr Duration kMs = kMillisecond;
  EXPECT_EQ(scan_period({0, 100 * kMs, 200 * kMs, 400 * kMs}, 50 * kMs, 0.5), 100 * kMs);
  EXPECT_EQ(scan_period({0, 200 * kMs, 400 * kMs}, 50 * kMs, 0.5), 100 * kMs);
  // Blind in the middle of the scan: its span is a whole turn.
  EXPECT_EQ(scan_period({0, 100 * kMs, 200 * kMs, 400 * kMs}, 99 * kMs, 0.5), 100 * kMs);
  // Of a narrow LiDAR that does not turn.
  EXPECT_EQ(scan_period({0, 200 * kMs, 400 * kMs}, 99 * kMs, 0.2), 100 * kMs);
  EXPECT_EQ(scan_period({0, 80 * kMs, 190 * kMs, 310 * kMs, 400 * kMs}, 50 * kMs, 0.5), 100 * kMs)
      << "stamps that jitter";
  EXPECT_EQ(usual_spacing({0, 100, 200, 400}, 100), 100);
  EXPECT_EQ(usual_spacing({0, 200, 400, 800}, 100), 200);
}

TEST(PointTime, KeepsTheDigitsOfSecondsSinceTheEpoch) {
  EXPECT_EQ(point_time(0.0125F, 1e9), std::llround(double{0.0125F} * 1e9));
  EXPECT_EQ(point_time(-1.5, 1e6), -1'500'000);
  EXPECT_EQ(point_time(1'700'000'000.25, 1e9), 1'700'000'000'250'000'000);
  EXPECT_EQ(point_time(std::nan(""), 1e9), std::nullopt);
  EXPECT_EQ(point_time(1e300, 1e9), std::nullopt);
  EXPECT_EQ(point_time(-1e10, 1e9), std::nullopt);
}

TEST(LegNames, FollowTheConventionsOfManyRobots) {
  for (const char* name : {"FL_hip_joint", "LF_HAA", "fl.hx", "front_left_hip_x", "/LF/hip",
                           "left_front_shoulder", "FL_HipX_joint", "lf_hip_roll", "FrontLeft_coxa",
                           "front left shoulder abduction motor", "FL_hip_motor_2_chassis_joint"}) {
    EXPECT_EQ(leg_of_name(name), 0) << name;
    EXPECT_EQ(joint_of_name(name), 0) << name;
  }
  for (const char* name :
       {"RR_calf_joint", "RH_KFE", "hr.kn", "rear_right_knee", "hind-right-lower", "HR_Knee_joint",
        "RearRight_tibia", "rear right elbow motor", "RR_lower_leg_2_upper_leg_joint"}) {
    EXPECT_EQ(leg_of_name(name), 3) << name;
    EXPECT_EQ(joint_of_name(name), 2) << name;
  }
  for (const char* name : {"RL_thigh_joint", "LH_HFE", "hl.hy", "rear_left_hip_y", "HL_HipY_joint",
                           "lh_hip_pitch", "HindLeft_femur", "LH_hip_flexion",
                           "rear left shoulder rotation motor", "RL_upper_leg_2_hip_motor_joint"}) {
    EXPECT_EQ(leg_of_name(name), 2) << name;
    EXPECT_EQ(joint_of_name(name), 1) << name;
  }
  EXPECT_EQ(leg_of_name("arm_joint_1"), std::nullopt);
  EXPECT_EQ(leg_of_name(""), std::nullopt);
  EXPECT_EQ(joint_of_name("wheel"), std::nullopt);
}

TEST(LegNames, AHipBesideAnAbadIsTheJointThatPitches) {
  std::vector<std::string> text;
  for (const char* leg : {"fr", "fl", "hr", "hl"}) {
    for (const char* joint : {"abad", "hip", "knee"}) {
      text.push_back(std::string(joint) + '_' + leg + "_joint");
    }
  }
  const std::vector<std::string_view> names(text.begin(), text.end());
  const auto order = joint_order(names, {}, 12);
  ASSERT_TRUE(order);
  EXPECT_EQ(*order, (JointOrder{3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8}));
}

TEST(LegNames, UnknownNamesOfTwelveJointsTellNoOrder) {
  const std::vector<std::string> unknown = {"j1", "j2", "j3", "j4",  "j5",  "j6",
                                            "j7", "j8", "j9", "j10", "j11", "j12"};
  const std::vector<std::string_view> names(unknown.begin(), unknown.end());
  EXPECT_EQ(joint_order(names, {}, 12), std::nullopt);
  EXPECT_TRUE(joints_are_unnamed(names, 12));
  EXPECT_FALSE(joints_are_unnamed(names, 13));
  std::vector<std::string> configured(unknown.rbegin(), unknown.rend());
  EXPECT_EQ((*joint_order(names, configured, 12))[0], 11U);
  configured[4] = "absent";
  EXPECT_EQ(joint_order(names, configured, 12), std::nullopt);
}

TEST(LegNames, FeetAreOrderedByConfigurationThenByName) {
  const std::vector<std::string> unitree = {"FR", "FL", "RR", "RL"};
  EXPECT_EQ(foot_order({}, unitree, 4), (std::vector<int>{1, 0, 3, 2}));
  EXPECT_EQ(foot_order({}, {}, 4), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(foot_order({}, {}, 5), std::nullopt);
  const std::vector<std::string_view> named = {"RH_foot", "LF_foot", "RF_foot", "LH_foot"};
  EXPECT_EQ(foot_order(named, {}, 4), (std::vector<int>{3, 0, 1, 2}));
}

Pose random_pose(RandomStream& random) { return {so3_exp(random.normal3()), random.normal3()}; }

TEST(FrameTree, ASingleTransformIsUnchanged) {
  RandomStream random(5, "test");
  const Pose pose = random_pose(random);
  FrameTree tree;
  EXPECT_TRUE(tree.add("imu", "/lidar", pose));
  EXPECT_FALSE(tree.add("imu", "imu", pose));
  EXPECT_TRUE(tree.add("imu", "lidar", random_pose(random)));  // the first holds
  test::expect_same_pose(*tree.transform("/imu", "lidar"), pose);
  EXPECT_EQ(tree.transform("imu", "camera"), std::nullopt);
}

TEST(FrameTree, ChainsOfAnyDirectionMultiplyOut) {
  RandomStream random(6, "test");
  const Pose T_a_b = random_pose(random), T_c_b = random_pose(random), T_c_d = random_pose(random);
  FrameTree tree;
  tree.add("a", "b", T_a_b);
  tree.add("c", "b", T_c_b);
  tree.add("c", "d", T_c_d);
  const Pose found = *tree.transform("a", "d");
  const Eigen::Vector3d p = random.normal3();
  const Eigen::Vector3d expected = T_a_b * (T_c_b.inverse() * (T_c_d * p));
  EXPECT_LT((found * p - expected).norm(), 1e-12);
  EXPECT_EQ(tree.chain("a", "d"), (std::vector<std::string>{"a", "b", "c", "d"}));
}

TEST(FrameTree, FindsTransformsThatContradictAChain) {
  const Pose near{Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.0}};
  const Pose far{Eigen::Quaterniond::Identity(), {5.1, 0.0, 0.0}};
  FrameTree tree;
  tree.add("base", "imu", Pose{});
  tree.add("base", "lidar", near);
  tree.add("base", "lidar", near);
  tree.add("imu", "lidar", near);  // another way to the same place
  EXPECT_FALSE(tree.contradiction("imu", "lidar"));
  tree.add("base", "odom", Pose{});
  tree.add("base", "odom", far);  // as a robot that moves
  EXPECT_FALSE(tree.contradiction("imu", "lidar"));
  tree.add("imu", "lidar", far);
  ASSERT_TRUE(tree.contradiction("imu", "lidar"));
  EXPECT_NEAR(tree.contradiction("imu", "lidar")->distance, 5.0, 1e-9);

  FrameTree two_ways;
  two_ways.add("imu", "lidar", far);
  two_ways.add("base", "imu", Pose{});
  two_ways.add("base", "lidar", near);
  ASSERT_TRUE(two_ways.contradiction("imu", "lidar"));
  EXPECT_NEAR(two_ways.contradiction("imu", "lidar")->distance, 5.0, 1e-9);
}

TEST(FrameTree, InvalidTransformsAreRejected) {
  FrameTree tree;
  Pose pose;
  pose.rotation.coeffs().setZero();
  EXPECT_FALSE(tree.add("a", "b", pose));
  pose = {};
  pose.translation.x() = std::nan("");
  EXPECT_FALSE(tree.add("a", "b", pose));
  EXPECT_FALSE(tree.add("", "b", {}));
  EXPECT_FALSE(tree.contains("b"));
}

TEST(RecordingConfig, EveryFieldIsSetByItsKey) {
  RecordingConfig config;
  const Fields fields = fields_of(config);
  EXPECT_TRUE(assign(fields, "topics.imu", "/imu"));
  EXPECT_TRUE(assign(fields, "imu_unit", "g"));
  EXPECT_TRUE(assign(fields, "point_time_unit", "us"));
  EXPECT_TRUE(assign(fields, "cloud_stamp", "end"));
  EXPECT_TRUE(assign(fields, "T_imu_lidar.translation", "[0.1, 0, 0.2]"));
  EXPECT_TRUE(assign(fields, "foot_names", "[FR, FL, RR, RL]"));
  EXPECT_TRUE(assign(fields, "leg_geometry.thigh", "0.3"));
  EXPECT_FALSE(assign(fields, "leg_geometry.foot_radius", "5"));
  EXPECT_FALSE(assign(fields, "leg_geometry.hip_x", "3"));
  EXPECT_FALSE(assign(fields, "contact_threshold", "-5"));
  EXPECT_EQ(config.imu_unit, ImuUnit::kGravities);
  EXPECT_EQ(config.foot_names.at(1), "FL");
  EXPECT_EQ(config.leg_geometry.thigh, 0.3);
}

}  // namespace
}  // namespace aims
