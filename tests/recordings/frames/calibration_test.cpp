// SPDX-License-Identifier: BSD-3-Clause
// One transform, written as other tools write it, reads as one value.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/config.hpp"
#include "recordings/frames/calibration_file.hpp"
#include "recordings/frames/configured_extrinsic.hpp"
#include "recordings/frames/static_transform.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr double kRoll = 0.1, kPitch = -0.25, kYaw = 2.0;  // [rad]
const Eigen::Vector3d kTranslation(0.1, -0.2, 0.35);

/// By the definition of the angles, written out: independent of the code under test.
Eigen::Matrix3d rotation() {
  const double cr = std::cos(kRoll), sr = std::sin(kRoll);
  const double cp = std::cos(kPitch), sp = std::sin(kPitch);
  const double cy = std::cos(kYaw), sy = std::sin(kYaw);
  Eigen::Matrix3d R;
  R << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  return R;
}

Eigen::Matrix4d T_imu_lidar() {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = rotation();
  T.topRightCorner<3, 1>() = kTranslation;
  return T;
}

std::string flat(const Eigen::MatrixXd& m) {
  std::string text;
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    text += fmt::format("{}{:.12f}", i == 0 ? "" : ", ", m(i / m.cols(), i % m.cols()));
  }
  return text;
}

std::string rows(const Eigen::MatrixXd& m) {
  std::string text;
  for (Eigen::Index i = 0; i < m.rows(); ++i) text += "\n  - [" + flat(m.row(i)) + "]";
  return text;
}

/// Half-angle products, written out.
Eigen::Vector4d quaternion_xyzw() {
  const double cr = std::cos(kRoll / 2), sr = std::sin(kRoll / 2);
  const double cp = std::cos(kPitch / 2), sp = std::sin(kPitch / 2);
  const double cy = std::cos(kYaw / 2), sy = std::sin(kYaw / 2);
  return {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
          cr * cp * cy + sr * sp * sy};
}

/// x y z qx qy qz qw.
std::string seven(const Eigen::Matrix4d& T) {
  const Eigen::Quaterniond q(Eigen::Matrix3d(T.topLeftCorner<3, 3>()));
  return flat(T.topRightCorner<3, 1>()) +
         fmt::format(", {:.12f}, {:.12f}, {:.12f}, {:.12f}", q.x(), q.y(), q.z(), q.w());
}

void expect_right(const Result<Pose>& pose, const std::string& what) {
  ASSERT_TRUE(pose) << what << ": " << pose.error().message;
  EXPECT_LT((pose->translation - kTranslation).norm(), 1e-9) << what;
  EXPECT_LT((pose->R() - rotation()).norm(), 1e-9) << what;
}

/// T_imu_lidar as numbers in files, directly.
std::vector<std::string> written_directly() {
  const Eigen::Matrix4d T = T_imu_lidar();
  const Eigen::Matrix4d inverse = T.inverse();
  const Eigen::Vector4d q = quaternion_xyzw();
  Eigen::Matrix4d in_mm = T;
  in_mm.topRightCorner<3, 1>() *= 1000.0;
  return {
      "T_imu_lidar: [" + flat(T) + "]\n", "T_imu_lidar: [" + flat(T.topRows<3>()) + "]\n",
      "T_lidar_imu:" + rows(inverse) + "\n",
      "%YAML:1.0\n---\nT_IMU_LiDAR: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: d\n   data: "
      "[ " +
          flat(T) + " ]\n",
      "imu_T_lidar: [" + flat(T) + "]\n", "lidar_in_imu: [" + flat(T) + "]\n",
      "imu_in_lidar:\n  translation: [" + flat(inverse.topRightCorner<3, 1>()) +
          "]\n  rotation_matrix: [" + flat(inverse.topLeftCorner<3, 3>()) + "]\n",
      "lidar_in_imu:\n  translation: [" + flat(kTranslation) + "]\n  quaternion_xyzw: [" + flat(q) +
          "]\n",
      "lidar_in_imu: {translation: [" + flat(kTranslation) + "], rotation_rpy_deg: [" +
          flat(Eigen::Vector3d(kRoll, kPitch, kYaw) * (180.0 / std::numbers::pi)) + "]}\n",
      "mapping:\n  extrinsic_T: [" + flat(kTranslation) + "]\n  extrinsic_R: [" + flat(rotation()) +
          "]\n",
      // Ouster: the IMU is the sensor's frame here; translations in mm.
      R"({"imu_intrinsics": {"imu_to_sensor_transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]},
         "lidar_intrinsics": {"lidar_to_sensor_transform": [)" +
          flat(in_mm) + "]}}"};
}

/// T_imu_lidar as files of camera calibrations state it: by way of another sensor.
std::vector<std::string> written_through_cameras() {
  const Eigen::Matrix4d T = T_imu_lidar();
  Eigen::Matrix4d T_cam_imu = Eigen::Matrix4d::Identity();
  T_cam_imu.topLeftCorner<3, 3>() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  T_cam_imu.topRightCorner<3, 1>() << 0.01, 0.02, 0.03;
  return {
      // Kalibr: both are known in the camera alone.
      "cam0:\n  T_cam_imu:" + std::string("\n  - [") + flat(T_cam_imu.row(0)) + "]\n  - [" +
          flat(T_cam_imu.row(1)) + "]\n  - [" + flat(T_cam_imu.row(2)) + "]\n  - [" +
          flat(T_cam_imu.row(3)) + "]\n  camera_model: pinhole\n  T_cam_lidar: [" +
          flat(T_cam_imu * T) + "]\n",
      // MultiCal: sensors in the reference, which is the IMU or a camera.
      "lidar0:\n  T_here_imu0:" + rows(T.inverse()) +
          "\n  relative_point_timestamp: false\n  rostopic: /rslidar_points\n",
      R"({"imu0": {"T_here_cam0": [)" + flat(T_cam_imu.inverse()) +
          R"(]}, "lidar0": {"T_here_cam0": [)" + flat((T_cam_imu * T).inverse()) + "]}}",
      // Oxford Spires: one of three cameras has both.
      "sensor:\n  cameras:\n    - label: cam_left\n      T_cam_lidar_t_xyz_q_xyzw: [9, 9, 9, 0, 0, "
      "0, "
      "1]\n    - label: cam_front\n      T_cam_lidar_t_xyz_q_xyzw: [" +
          seven(T_cam_imu * T) + "]\n      T_cam_imu_t_xyz_q_xyzw: [" + seven(T_cam_imu) +
          "]\n  T_base_lidar_t_xyz_q_xyzw: [0.0, 0.0, 0.124, 0.0, 0.0, 1.0, 0.0]\n"};
}

/// T_imu_lidar as ROS publishes it.
std::vector<std::string> written_for_ros() {
  const Eigen::Vector4d q = quaternion_xyzw();
  const std::string xyz =
      fmt::format("{} {} {}", kTranslation.x(), kTranslation.y(), kTranslation.z());
  return {
      fmt::format("static_transform_publisher {} {} {} {} imu lidar 100\n", xyz, kYaw, kPitch,
                  kRoll),
      fmt::format("rosrun tf2_ros static_transform_publisher {} {} {} {} {} imu lidar\n", xyz, q[0],
                  q[1], q[2], q[3]),
      fmt::format("ros2 run tf2_ros static_transform_publisher --x {} --y {} --z {} --roll {} "
                  "--pitch {} --yaw {} --frame-id imu --child-frame-id lidar\n",
                  kTranslation.x(), kTranslation.y(), kTranslation.z(), kRoll, kPitch, kYaw),
      fmt::format(
          "<launch>\n<!-- static_transform_publisher -->\n<node pkg=\"tf2_ros\" "
          "type=\"static_transform_publisher\" name=\"a\"\n  args=\"{} {} {} {} imu lidar\" "
          "/>\n</launch>\n",
          xyz, kYaw, kPitch, kRoll),
      fmt::format("<robot name=\"r\">\n<joint name=\"a\" type=\"fixed\">\n<origin rpy=\"{} {} {}\" "
                  "xyz=\"{}\"/><parent link=\"imu\"/>\n<child link=\"mount\"/></joint>\n<joint "
                  "name=\"b\" type=\"fixed\"><parent link='mount'/><child link='lidar'/></joint>\n"
                  "<joint name=\"knee\" type=\"revolute\"><origin xyz=\"9 9 9\"/><parent "
                  "link=\"imu\"/><child link=\"calf\"/></joint></robot>",
                  kRoll, kPitch, kYaw, xyz)};
}

/// T_imu_lidar in every format of a file.
std::vector<std::string> written() {
  std::vector<std::string> all = written_directly();
  for (const auto& more : {written_through_cameras(), written_for_ros()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

TEST(Calibration, OneTransformInEveryFormatIsOneValue) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "calibration.txt";
  for (const std::string& text : written()) {
    std::ofstream(file) << text;
    expect_right(read_extrinsic(file, "", ""), text);
    ExtrinsicConfig config;
    config.file = file.string();
    EXPECT_TRUE(config.is_given());
    expect_right(configured_extrinsic(config, "T_imu_lidar"), text);
  }
}

TEST(Calibration, NumbersOfAConfigurationAreTheSameInEitherDirection) {
  const Eigen::Matrix4d inverse = T_imu_lidar().inverse();
  const Eigen::Quaterniond q(Eigen::Matrix3d(inverse.topLeftCorner<3, 3>()));
  const std::string t = "[" + flat(kTranslation) + "]";
  const std::string t_inverse = "[" + flat(inverse.topRightCorner<3, 1>()) + "]";
  using Settings = std::vector<std::pair<std::string, std::string>>;
  const std::vector<Settings> all = {
      {{"matrix", "[" + flat(T_imu_lidar()) + "]"}},
      {{"matrix", "[" + flat(inverse) + "]"}, {"direction", "imu_in_lidar"}},
      {{"translation", t}, {"rotation_matrix", "[" + flat(rotation()) + "]"}},
      {{"translation", t}, {"quaternion_xyzw", "[" + flat(quaternion_xyzw()) + "]"}},
      {{"translation", t_inverse},
       {"quaternion_xyzw", fmt::format("[{}, {}, {}, {}]", q.x(), q.y(), q.z(), q.w())},
       {"direction", "imu_in_lidar"}},
      {{"translation", t},
       {"rotation_rpy_deg",
        "[" + flat(Eigen::Vector3d(kRoll, kPitch, kYaw) * (180.0 / std::numbers::pi)) + "]"},
       {"override_tf", "true"}},
      {{"translation", t},
       {"rotation_rpy_deg",
        "[" + flat(Eigen::Vector3d(kRoll, kPitch, kYaw) * (180.0 / std::numbers::pi)) + "]"}},
      {{"translation", t_inverse},
       {"quaternion_wxyz", fmt::format("[{}, {}, {}, {}]", q.w(), q.x(), q.y(), q.z())},
       {"direction", "imu_in_lidar"}},
      {{"static_transform", fmt::format("0.1 -0.2 0.35 {} {} {} imu lidar", kYaw, kPitch, kRoll)}},
      // Of the IMU in the LiDAR, by its frames, whether or not the direction says so too.
      {{"static_transform", fmt::format("{} {} {} {} {} {} {} os_lidar imu_link", inverse(0, 3),
                                        inverse(1, 3), inverse(2, 3), q.x(), q.y(), q.z(), q.w())}},
      {{"static_transform", fmt::format("{} {} {} {} {} {} {} os_lidar imu_link", inverse(0, 3),
                                        inverse(1, 3), inverse(2, 3), q.x(), q.y(), q.z(), q.w())},
       {"direction", "imu_in_lidar"}}};
  for (const Settings& settings : all) {
    RecordingConfig config;
    auto fields = fields_of(config);
    for (const auto& [key, value] : settings) {
      ASSERT_TRUE(assign(fields, "T_imu_lidar." + key, value)) << key << ' ' << value;
    }
    expect_right(configured_extrinsic(config.T_imu_lidar, "T_imu_lidar"), settings[0].first);
    const auto plain = with_plain_extrinsics(config);
    ASSERT_TRUE(plain);
    expect_right(configured_extrinsic(plain->T_imu_lidar, "T_imu_lidar"), "plain");
  }
}

TEST(Calibration, FramesThatContradictTheDirectionAreAnError) {
  ExtrinsicConfig config;
  config.static_transform = "0.1 0 0 0 0 0 imu lidar";
  config.direction = ExtrinsicDirection::kImuInSensor;
  const auto pose = configured_extrinsic(config, "T_imu_lidar");
  ASSERT_FALSE(pose);
  EXPECT_NE(pose.error().message.find("which the direction contradicts"), std::string::npos);
}

TEST(Calibration, FilesAreFoundBesideTheConfigurationThatNamesThem) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "calibration.yaml") << "a: 1\n";
  RecordingConfig config;
  config.T_imu_lidar.file = "calibration.yaml";
  config.T_imu_base.file = "/absolute.yaml";
  find_calibrations(config, folder.path());
  EXPECT_EQ(config.T_imu_lidar.file, (folder.path() / "calibration.yaml").string());
  EXPECT_EQ(config.T_imu_base.file, "/absolute.yaml");
}

TEST(Calibration, WhatIsNoRigidTransformIsRefusedByItsPlace) {
  const auto message = [](const std::string& text) {
    const auto parsed = parse_calibration(text, "c.yaml");
    return parsed ? std::string() : parsed.error().message;
  };
  Eigen::Matrix4d T = T_imu_lidar();
  T.row(0).head<3>() *= -1.0;
  EXPECT_NE(message("a: 1\nT_imu_lidar: [" + flat(T) + "]")
                .find("c.yaml:2: T_imu_lidar: expected a "
                      "rotation matrix of determinant +1"),
            std::string::npos);
  T = T_imu_lidar();
  T(0, 0) += 0.2;
  EXPECT_NE(message("T_imu_lidar: [" + flat(T) + "]").find("no unit vectors at right angles"),
            std::string::npos);
  T = T_imu_lidar();
  T(3, 3) = 2.0;
  EXPECT_NE(message("T_imu_lidar: [" + flat(T) + "]").find("expected 0 0 0 1"), std::string::npos);
  T = T_imu_lidar();
  T(0, 3) = 350.0;
  EXPECT_NE(message("T_imu_lidar: [" + flat(T) + "]").find("in metres"), std::string::npos);
  EXPECT_NE(message("T_base_lidar_t_xyz_q_xyzw: [0, 0, 0, 1]").find("expected 7 numbers: x y z qx"),
            std::string::npos);
  EXPECT_NE(message("\nstatic_transform_publisher 1 2 3 imu lidar").find("c.yaml:2: expected 'x y"),
            std::string::npos);
  EXPECT_NE(message("<robot>\n<joint type='fixed'>\n<child link='b'/></joint></robot>")
                .find("c.yaml:3: expected a fixed joint"),
            std::string::npos);
  EXPECT_NE(parse_static_transform("0 0 0 0 0 0 2 a b", "here")
                .error()
                .message.find("here: expected a unit quaternion, found one of norm 2"),
            std::string::npos);
}

TEST(Calibration, FramesThatAreNotThereAreNamed) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "c.yaml";
  std::ofstream(file) << "T_imu_cam: [" + flat(T_imu_lidar()) + "]\n";
  const auto none = read_extrinsic(file, "", "");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("expected one frame as the LiDAR; there are cam, imu"),
            std::string::npos);
  expect_right(read_extrinsic(file, "imu", "cam"), "by name");
  ExtrinsicConfig both;
  both.file = file.string();
  both.matrix.assign(16, 0.0);
  EXPECT_NE(configured_extrinsic(both, "T_imu_lidar").error().message.find("found several"),
            std::string::npos);
}

}  // namespace
}  // namespace aims
