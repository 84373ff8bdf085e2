// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/trajectory_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>

#include "core/files/pose_cleaning.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/trajectories/bag_trajectory.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr Time kEpoch = 1'600'000'000 * kSecond;

Pose pose_number(int i) { return {yaw_rotation(0.1 * i), {1.0 * i, -0.5 * i, 0.25}}; }

MessageType pose_stamped_type() {
  const MessageType odometry = odometry_type();
  return {
      "geometry_msgs/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5",
      "Header header\nPose pose\n" + odometry.definition.substr(odometry.definition.find("\n="))};
}

MessageType path_type() {
  const MessageType pose = pose_stamped_type();
  const std::string rest = pose.definition.substr(pose.definition.find("\n="));
  return {"nav_msgs/Path", "6227e2b7e9cce15051f669a5e197bbf7",
          "Header header\ngeometry_msgs/PoseStamped[] poses\n\n" + std::string(80, '=') +
              "\nMSG: geometry_msgs/PoseStamped\nHeader header\nPose pose\n" + rest};
}

void put_header(MessageBytes& bytes, Time stamp) {
  bytes.put(std::uint32_t{7});
  bytes.time(stamp);
  bytes.text("world");
}

void put_pose(MessageBytes& bytes, const Pose& pose) {
  for (const double value : pose.translation) bytes.put(value);
  for (const double value : pose.rotation.coeffs()) bytes.put(value);
}

class TrajectoryFiles : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) const {
    const auto path = folder_.path() / name;
    std::ofstream(path) << text;
    return path.string();
  }

  /// Ten poses as odometry on "/odom", stamped from `first` on, and more topics when asked.
  std::string bag(Time first, bool more) const {
    const auto path = folder_.path() / "run.bag";
    auto writer = BagWriter::create(path);
    EXPECT_TRUE(writer);
    const auto odometry = writer->add_connection("/odom", odometry_type());
    std::optional<std::uint32_t> path_id;
    std::optional<std::uint32_t> pose_id;
    if (more) path_id = writer->add_connection("/path", path_type());
    if (more) pose_id = writer->add_connection("/pose", pose_stamped_type());
    for (int i = 0; i < 10; ++i) {
      const Time stamp = first == 0 ? 0 : first + i * kSecond;
      const Time record_time = kEpoch + i * kSecond;
      const MessageHeader header{0, stamp, "world"};
      const auto message = odometry_message(header, "imu", {pose_number(i), {}, {}});
      EXPECT_TRUE(writer->write(odometry, record_time, message.view()));
      if (!more) continue;
      MessageBytes pose;
      put_header(pose, stamp);
      put_pose(pose, pose_number(i));
      EXPECT_TRUE(writer->write(*pose_id, record_time, pose.view()));
      MessageBytes grown;  // a path repeats what it had
      put_header(grown, stamp);
      grown.length(static_cast<std::size_t>(i) + 1);
      for (int k = 0; k <= i; ++k) {
        put_header(grown, first + k * kSecond);
        put_pose(grown, pose_number(k));
      }
      EXPECT_TRUE(writer->write(*path_id, record_time, grown.view()));
    }
    EXPECT_TRUE(writer->close());
    return path.string();
  }

  static std::string message_of(const std::string& source, TrajectoryFileOptions options = {}) {
    const auto read = read_trajectory(source, options);
    return read ? "" : read.error().message;
  }

  static void expect_ten_poses(const Result<TrajectoryFile>& read, Time first) {
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->trajectory.size(), 10U);
    for (int i = 0; i < 10; ++i) {
      const StampedPose& each = read->trajectory[static_cast<std::size_t>(i)];
      EXPECT_EQ(each.stamp, first + i * kSecond);
      EXPECT_EQ(each.pose.translation, pose_number(i).translation);
      EXPECT_TRUE(each.pose.rotation.isApprox(pose_number(i).rotation, 1e-15));
    }
  }

  TemporaryFolder folder_;
};

TEST_F(TrajectoryFiles, TheKindFollowsFromTheContent) {
  const auto tum = read_trajectory(file("a.txt", "# c\n1 0 0 0 0 0 0 1\n"), {});
  ASSERT_TRUE(tum) << tum.error().message;
  EXPECT_EQ(tum->kind, "TUM");
  const auto kitti =
      read_trajectory(file("b.txt", "1 0 0 4 0 1 0 5 0 0 1 6\n"),
                      {.rules = PoseRules::kStrict, .stamps = {{"times.txt", {3 * kSecond}}}});
  ASSERT_TRUE(kitti) << kitti.error().message;
  EXPECT_EQ(kitti->kind, "KITTI poses");
  EXPECT_EQ(kitti->trajectory.front().stamp, 3 * kSecond);
  EXPECT_NE(kitti->notes.front().find("take the stamps of times.txt"), std::string::npos);
  const auto bagged = read_trajectory(bag(kEpoch, false), {});
  ASSERT_TRUE(bagged) << bagged.error().message;
  EXPECT_EQ(bagged->kind, "nav_msgs/Odometry on /odom");
}

TEST_F(TrajectoryFiles, PositionsAreReadFromTextTablesAndPoints) {
  const std::string texts[] = {"1.5 1 2 3\n2.5 4 5 6\n", "1.5,1,2,3\n2.5,4,5,6",
                               "time,x,y,z,sigma\n1.5, 1, 2, 3, 9\n2.5, 4, 5, 6, 9\n"};
  for (const std::string& text : texts) {
    const auto read = read_trajectory(file("p.csv", text), {});
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_FALSE(read->has_attitude);
    ASSERT_EQ(read->trajectory.size(), 2U);
    EXPECT_EQ(read->trajectory[0].stamp, 1'500'000'000);
    EXPECT_EQ(read->trajectory[1].pose.translation, Eigen::Vector3d(4, 5, 6));
  }
  EXPECT_NE(message_of(file("p", "1 2 3 4\n1 2 3\n")).find("p:2: expected a position"),
            std::string::npos);
  const auto path = folder_.path() / "prism.bag";
  auto writer = BagWriter::create(path);
  const MessageType odometry = odometry_type();
  const std::string header = odometry.definition.substr(odometry.definition.find("\n="));
  const auto id = writer->add_connection(
      "/prism", {"geometry_msgs/PointStamped", "c63aecb41bfdfd6b7e1fac37c7cbe7bf",
                 "Header header\nPoint point\n" + header});
  MessageBytes point;
  put_header(point, kEpoch);
  for (const double value : {1.0, 2.0, 3.0}) point.put(value);
  EXPECT_TRUE(writer->write(id, kEpoch, point.view()));
  EXPECT_TRUE(writer->close());
  const auto read = read_trajectory(path.string(), {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->kind, "geometry_msgs/PointStamped on /prism");
  EXPECT_FALSE(read->has_attitude);
  EXPECT_EQ(read->trajectory.front().pose.translation, Eigen::Vector3d(1, 2, 3));
}

TEST_F(TrajectoryFiles, TransformsOfTwoFramesAreATrajectory) {
  const auto path = folder_.path() / "tf.bag";
  auto writer = BagWriter::create(path);
  const auto tf = writer->add_connection("/tf", transforms_type());
  const auto fixed = writer->add_connection("/tf_static", transforms_type());
  const Pose T_odom_map{yaw_rotation(0.5), {0.1, 0.0, 0.0}};  // the tree has map below odom
  const Pose T_base_imu{yaw_rotation(-1.0), {0.0, 0.0, 0.3}};
  EXPECT_TRUE(
      writer->write(fixed, kEpoch, transforms_message(0, {{"base", "imu", T_base_imu}}).view()));
  for (int i = 0; i < 10; ++i) {
    const Time stamp = kEpoch + i * kSecond;
    const auto moving = transforms_message(stamp, {{"odom", "/base", pose_number(i)}});
    EXPECT_TRUE(writer->write(tf, stamp, moving.view()));
    if (i % 9 != 0) continue;
    const auto slow = transforms_message(stamp, {{"odom", "map", T_odom_map}});
    EXPECT_TRUE(writer->write(tf, stamp, slow.view()));
  }
  EXPECT_TRUE(writer->close());
  const auto direct = read_trajectory(path.string() + ":/tf:odom,base", {});
  expect_ten_poses(direct, kEpoch);
  EXPECT_EQ(direct->body_frame, "base");
  const auto chain = read_trajectory(path.string() + ":/tf:map,imu", {});
  ASSERT_TRUE(chain) << chain.error().message;
  ASSERT_EQ(chain->trajectory.size(), 10U);
  const Pose expected = T_odom_map.inverse() * pose_number(4) * T_base_imu;
  EXPECT_TRUE(chain->trajectory[4].pose.translation.isApprox(expected.translation, 1e-12));
  EXPECT_LT(chain->trajectory[4].pose.rotation.angularDistance(expected.rotation), 1e-7);
  EXPECT_NE(message_of(path.string() + ":/tf")
                .find("as tf.bag:/tf:PARENT,CHILD; there are "
                      "base,imu odom,base odom,map"),
            std::string::npos)
      << message_of(path.string() + ":/tf");
}

TEST_F(TrajectoryFiles, TextErrorsNameFileAndLine) {
  EXPECT_NE(message_of(file("a", "# c\n1 2 3\n")).find("a:2: expected 8 columns (TUM"),
            std::string::npos);
  EXPECT_NE(message_of(file("a", "\n# c\n")).find("a:1: expected poses"), std::string::npos);
  EXPECT_NE(message_of(file("a", "1 0 0 0 0 0 0 1\n1 0 0\n")).find("a:2: expected 8 columns"),
            std::string::npos);
  EXPECT_NE(message_of("/nonexistent.tum").find("/nonexistent.tum: cannot be read"),
            std::string::npos);
  EXPECT_NE(message_of("/nonexistent.tum:/odom").find("/nonexistent.tum"), std::string::npos);
}

TEST_F(TrajectoryFiles, UnusablePosesOfATruthAreLeftOutWithTheirCauses) {
  const std::string text =
      "\xef\xbb\xbf+1 0 0 0 0 0 0 1\n1 5 0 0 0 0 0 1\n2 nan 0 0 0 0 0 1\n3 1 0 0 0 0 0.6 0.79\n"
      "4 1 0 0 0 0 0 2\n";
  const auto read = read_trajectory(file("truth.txt", text), {});
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->trajectory.size(), 2U);
  EXPECT_EQ(read->trajectory[1].stamp, 3 * kSecond);
  EXPECT_NEAR(read->trajectory[1].pose.rotation.norm(), 1.0, 1e-15);
  ASSERT_EQ(read->notes.size(), 3U);
  EXPECT_NE(read->notes[0].find("truth.txt:3: x is NaN"), std::string::npos) << read->notes[0];
  EXPECT_NE(read->notes[1].find("1 of 5 quaternions have norms of 0.992"), std::string::npos);
  EXPECT_NE(read->notes[2].find("3 of 5 poses dropped: 1 not finite, 1 without a unit quaternion, "
                                "1 with the stamp of the one before"),
            std::string::npos)
      << read->notes[2];
}

TEST_F(TrajectoryFiles, StampsRoundedToSecondsAreSaid) {
  std::string text;
  for (int i = 0; i < 40; ++i) {
    text += std::to_string(100 + i / 10) + ' ' + std::to_string(0.1 * i) + " 0 0 0 0 0 1\n";
  }
  const auto read = read_trajectory(file("rounded.txt", text), {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->trajectory.size(), 4U);
  EXPECT_NE(read->notes.back().find("40 poses share 4 stamps: stamps are rounded"),
            std::string::npos)
      << read->notes.back();
}

TEST_F(TrajectoryFiles, TablesHaveWWhereTheirHeaderOrTheirStampsTell) {
  const std::vector<std::string> texts = {
      "#timestamp, p_x, p_y, p_z, q_RS_w [], q_x, q_y, q_z, v_x\n1500000000,1,2,3,0.8,0,0,0.6,9\n",
      "1403636580838555648,1,2,3,0.8,0,0,0.6\n",
      "sep=;\nt;x;y;z;qx;qy;qz;qw\n1.5;1;2;3;0;0;0.6;0.8\n", "1.5, 1, 2, 3, 0, 0, 0.6, 0.8\n"};
  for (const std::string& text : texts) {
    const auto read = read_trajectory(file("table.csv", text), {});
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->kind, "CSV");
    ASSERT_EQ(read->trajectory.size(), 1U) << text;
    EXPECT_NEAR(read->trajectory[0].pose.rotation.w(), 0.8, 1e-15) << text;
    EXPECT_EQ(read->trajectory[0].pose.translation, Eigen::Vector3d(1, 2, 3));
  }
  const auto euroc = read_trajectory(file("table.csv", texts[1]), {});
  EXPECT_EQ(euroc->trajectory[0].stamp, 1403636580838555648);
  EXPECT_NE(message_of(file("table.csv", "1,2\n")).find("table.csv:1: expected at least 4 columns"),
            std::string::npos);
  EXPECT_NE(message_of(file("wide.txt", "\xff\xfe\n")).find("UTF-16"), std::string::npos);
}

TEST_F(TrajectoryFiles, ColumnsAreFoundByTheirNames) {
  const std::vector<std::string> texts = {
      "#sec,nsec,x,y,z,qx,qy,qz,qw\n1700000001,5000000,1,2,-3,0,0,0.6,0.8\n",  // Newer College
      "timestamp x y z qx qy qz qw\n1700000001.005 1 2 -3 0 0 0.6 0.8\n",      // ENWIDE
      "t\tx\ty\tz\tqw\tqx\tqy\tqz\n1700000001.005\t1\t2\t-3\t0.8\t0\t0\t0.6\n",
      "index;time;x;y;z;qx;qy;qz;qw\r\n7;1700000001,005;1,0;2,0;-3,0;0;0;0,6;0,8\r\n",
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.position.x,"
      "field.pose.position.y,field.pose.position.z,field.pose.orientation.x,"
      "field.pose.orientation.y,field.pose.orientation.z,field.pose.orientation.w\n"
      "1800000000000000000,4,1700000001005000000,map,1,2,-3,0,0,0.6,0.8\n",  // rostopic echo -p
      "timestamp [us],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n"
      "1700000001005000,1,2,-3,0.8,0,0,0.6\n",
      "time_ms,x,y,z,qx,qy,qz,qw\n1700000001005,1,2,-3,0,0,0.6,0.8\n",
      "1700000001005 1 2 -3 0 0 0.6 0.8\n",
      "1700000001005000000 1 2 -3 0.8 0 0 0.6\n",
      "% a comment\n1700000001.005 1 2 -3 0 0 0.6 0.8\n",
      "# timestamp tx ty tz qw qx qy qz\n1700000001.005 1 2 -3 0.8 0 0 0.6\n",
      "# timestamp_s id x y z\n1700000001.005 1 2 -3 0 0 0.6 0.8\n",  // Hilti 2023
      "// a comment\n1700000001.005 1 2 -3 0 0 0.6 0.8 # and one more\n",
      "1700000001.005 1 2 -3 0 0 0.6 0.8\r1700000002 1 2 -3 0 0 0.6 0.8\r"};
  for (const std::string& text : texts) {
    const auto read = read_trajectory(file("table.csv", text), {});
    ASSERT_TRUE(read) << text << read.error().message;
    ASSERT_FALSE(read->trajectory.empty()) << text;
    const StampedPose& pose = read->trajectory[0];
    EXPECT_EQ(pose.stamp, 1700000001005000000) << text;
    EXPECT_EQ(pose.pose.translation, Eigen::Vector3d(1, 2, -3)) << text;
    EXPECT_NEAR(pose.pose.rotation.w(), 0.8, 1e-15) << text;
    EXPECT_NEAR(pose.pose.rotation.z(), 0.6, 1e-15) << text;
  }
}

TEST_F(TrajectoryFiles, VelocitiesAreNoPositions) {
  const std::string values = ",9,8,7,6,5,4,3,1,2,-3,0,0,0.6,0.8\n";
  for (const std::string& names :
       {std::string("timestamp,vel_x,vel_y,vel_z,acc_w,acc_x,acc_y,acc_z,pos_x,pos_y,pos_z,qx,qy,"
                    "qz,qw\n1700000001.005"),
        std::string("__time,/odom/twist/twist/linear/x,/odom/twist/twist/linear/y,"
                    "/odom/twist/twist/linear/z,/imu/angular_velocity/w,/imu/angular_velocity/x,"
                    "/imu/angular_velocity/y,/imu/angular_velocity/z,/odom/pose/pose/position/x,"
                    "/odom/pose/pose/position/y,/odom/pose/pose/position/z,"
                    "/odom/pose/pose/orientation/x,/odom/pose/pose/orientation/y,"
                    "/odom/pose/pose/orientation/z,/odom/pose/pose/orientation/w\n1700000001.005"),
        std::string("__time,/o/header/stamp/sec,/o/header/stamp/nanosec,a,b,c,d,e,"
                    "/o/pose/position/x,/o/pose/position/y,/o/pose/position/z,"
                    "/o/pose/orientation/x,/o/pose/orientation/y,/o/pose/orientation/z,"
                    "/o/pose/orientation/w\n1800000000,1700000001,5000000"),
        std::string("t,vx [m/s],vy [m/s],vz [m/s],w,x [m/s],y [m/s],z [m/s],x [m],y [m],z [m],qx,"
                    "qy,qz,qw\n1700000001.005")}) {
    const bool stamps = names.starts_with("__time,/o/");
    const auto read = read_trajectory(file("v.csv", names + values.substr(stamps ? 4 : 0)), {});
    ASSERT_TRUE(read) << names << read.error().message;
    ASSERT_EQ(read->trajectory.size(), 1U) << names;
    EXPECT_EQ(read->trajectory[0].stamp, 1700000001005000000) << names;
    EXPECT_EQ(read->trajectory[0].pose.translation, Eigen::Vector3d(1, 2, -3)) << names;
    EXPECT_NEAR(read->trajectory[0].pose.rotation.z(), 0.6, 1e-15) << names;
  }
  EXPECT_NE(message_of(file("v.csv", "t,linear.x,linear.y,linear.z\n1,2,3,4\n"))
                .find("expected columns of a position (x, y, z), found velocities"),
            std::string::npos);
}

TEST_F(TrajectoryFiles, MotivesPositionsStandBehindItsRotations) {
  const std::string groups = ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position\n";
  const std::string row = "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z\n0,1.5,0,0.6,0,0.8,";
  const std::string begin =
      "Format Version,1.23,Capture Frame Rate,120.0,Export Frame Rate,120.0,Rotation Type,"
      "Quaternion,Length Units,Millimeters\n\n,,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid "
      "Body,Rigid Body,Rigid Body\n";
  for (const std::string& text :
       {begin + groups + row + "1000,-3000,-2000\n", groups + row + "1,-3,-2\n"}) {
    const auto read = read_trajectory(file("m.csv", text + "1,2.5,,,,,,,\n"), {});
    ASSERT_TRUE(read) << text << read.error().message;
    ASSERT_EQ(read->trajectory.size(), 1U) << text;
    EXPECT_EQ(read->trajectory[0].stamp, 1500 * kMillisecond);
    EXPECT_EQ(read->trajectory[0].pose.translation, Eigen::Vector3d(1, 2, -3)) << text;
    EXPECT_NEAR(read->trajectory[0].pose.rotation.z(), 0.6, 1e-15) << text;
    EXPECT_NE(read->notes.at(0).find("export of Motive"), std::string::npos);
  }
}

/// The text in UTF-16 with a byte order mark.
std::string utf16(const std::string& text, bool little) {
  std::string bytes = little ? "\xff\xfe" : "\xfe\xff";
  for (const char c : text) {
    const std::string unit = {little ? c : '\0', little ? '\0' : c};
    bytes += unit;
  }
  return bytes;
}

TEST_F(TrajectoryFiles, Utf16OfEitherByteOrderIsTheSameText) {
  for (const std::string& text :
       {std::string("1.5 1 2 3 0 0 0.6 0.8\r\n"),
        std::string("t,x,y,z,qx,qy,qz,qw\r\n1.5,1,2,3,0,0,0.6,0.8\r\n")}) {
    for (const bool little : {true, false}) {
      const auto read = read_trajectory(file("wide.txt", utf16(text, little)), {});
      ASSERT_TRUE(read) << read.error().message;
      ASSERT_EQ(read->trajectory.size(), 1U);
      EXPECT_EQ(read->trajectory[0].stamp, 1500 * kMillisecond);
      EXPECT_EQ(read->trajectory[0].pose.translation, Eigen::Vector3d(1, 2, 3));
    }
    const std::string unmarked = utf16(text, true).substr(2);
    EXPECT_NE(message_of(file("wide.txt", unmarked)).find("UTF-16 without a byte order mark"),
              std::string::npos);
  }
}

TEST_F(TrajectoryFiles, PositionsHaveTheUnitOfTheirHeader) {
  for (const char* text : {"t,x [mm],y [mm],z [mm]\n1.5,1000,-2500.5,0\n",
                           "time_s;x_mm;y_mm;z_mm\n1,5;1000;-2500,5;0\n",
                           "# t [s] x [cm] y [cm] z [cm]\n1.5,100,-250.05,0\n",
                           "# time [s] x [m] y [m] z [m]\n1.5, 1, -2.5005, 0\n"}) {
    const auto read = read_trajectory(file("p.csv", text), {});
    ASSERT_TRUE(read) << text << read.error().message;
    ASSERT_EQ(read->trajectory.size(), 1U) << text;
    EXPECT_FALSE(read->has_attitude);
    EXPECT_NEAR((read->trajectory[0].pose.translation - Eigen::Vector3d(1, -2.5005, 0)).norm(), 0.0,
                1e-12)
        << text;
  }
}

TEST_F(TrajectoryFiles, AttitudesAreAnglesOrMatricesToo) {
  // 90 deg about z after 90 deg about x: R = Rz Rx.
  const std::string matrix = "0,0,1,1,1,0,0,2,0,1,0,3";
  for (const std::string& text :
       {"1500000000123456789," + matrix + "\n", "1500000000123456789," + matrix + ",0,0,0,1\n",
        std::string("1500000000.123456789 0 0 1 1 1 0 0 2 0 1 0 3\n"),
        std::string(
            "t,x,y,z,roll [deg],pitch [deg],yaw [deg]\n1500000000.123456789,1,2,3,90,0,90\n"),
        std::string("t x y z yaw pitch roll\n1500000000.123456789 1 2 3 1.5707963267948966 0 "
                    "1.5707963267948966\n")}) {
    const auto read = read_trajectory(file("m.csv", text), {});
    ASSERT_TRUE(read) << text << read.error().message;
    ASSERT_EQ(read->trajectory.size(), 1U) << text;
    EXPECT_TRUE(read->has_attitude);
    const StampedPose& each = read->trajectory[0];
    EXPECT_EQ(each.stamp, 1500000000123456789) << text;
    EXPECT_EQ(each.pose.translation, Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_NEAR((each.pose.R() * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, 1, 0)).norm(), 0.0,
                1e-12)
        << text;
    EXPECT_NEAR((each.pose.R() * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(0, 0, 1)).norm(), 0.0,
                1e-12)
        << text;
  }
  const auto mirrored = read_trajectory(file("m.txt", "1 -1 0 0 1 0 1 0 2 0 0 1 3\n"), {});
  ASSERT_TRUE(mirrored);
  EXPECT_TRUE(mirrored->trajectory.empty()) << "no rotation";
}

TEST_F(TrajectoryFiles, AShuffledTruthIsSorted) {
  const std::string pose = " 1 0 0 0 0 0.6 0.8\n";
  const auto read = read_trajectory(
      file("s.tum", "2" + pose + "1" + pose + "4" + pose + "3" + pose + "6" + pose + "5" + pose),
      {});
  ASSERT_TRUE(read);
  ASSERT_EQ(read->trajectory.size(), 6U);
  EXPECT_EQ(read->trajectory[0].stamp, kSecond);
  EXPECT_NE(read->notes.at(0).find("stamps go back 3 times: sorted"), std::string::npos);
}

TEST_F(TrajectoryFiles, LatitudeAndLongitudeAreNoPositions) {
  for (const char* text : {"timestamp,latitude,longitude,altitude\n1,46.1,7.2,500\n",
                           "# time lat lon alt\n1 46.1 7.2 500\n"}) {
    EXPECT_NE(message_of(file("gps.csv", text)).find("found latitude and longitude"),
              std::string::npos)
        << text;
  }
}

TEST_F(TrajectoryFiles, ACommentThatNamesOtherColumnsIsNoHeader) {
  // As the control points of Hilti 2023, with commas.
  const auto read =
      read_trajectory(file("p.csv", "# timestamp_s, id, x, y, z\n1.5,1,2,3,0,0,0.6,0.8\n"), {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->trajectory.at(0).pose.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_NE(read->notes.at(0).find("a comment names 5 columns"), std::string::npos);
}

TEST_F(TrajectoryFiles, APoseOfALostBodyIsLeftOutOfATruth) {
  const std::string origin = " 0 0 0 0 0 0 1\n", away = " 5 1 0 0 0 0.6 0.8\n";
  const auto read = read_trajectory(file("mocap.tum", "1" + origin + "2" + origin + "3" + away +
                                                          "4" + origin + "5" + away + "6" + origin),
                                    {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->trajectory.size(), 4U) << "those at the start are a start";
  EXPECT_NE(read->notes.at(0).find("2 exactly at the origin"), std::string::npos);
}

TEST_F(TrajectoryFiles, APoseBeforeTheBodyIsFoundIsLeftOutToo) {
  const std::string lost = " 0 0 0 0 0 0 1\n";
  std::string mocap, started;
  for (int i = 0; i < 50; ++i) {
    const std::string stamp = std::to_string(1.0 + 0.02 * i);
    const std::string x = std::to_string(3.0 + 0.01 * i), began = std::to_string(0.01 * i);
    mocap += stamp + (i % 10 < 2 ? lost : " " + x + " 3 3 0 0 0.6 0.8\n");
    started += stamp + (i < 2 ? lost : " " + began + " 0 0 0 0 0 1\n");
  }
  const auto read = read_trajectory(file("mocap.tum", mocap), {});
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->trajectory.size(), 40U);
  EXPECT_NEAR(read->trajectory.front().pose.translation.x(), 3.02, 1e-9);
  EXPECT_EQ(read_trajectory(file("odom.tum", started), {})->trajectory.size(), 50U);
}

TEST(PoseCleaning, LeapsOfATruthAreTold) {
  const auto text_of = [](double jump, bool frozen) {
    Trajectory truth;
    for (int i = 0; i < 100; ++i) {
      const bool still = frozen && i >= 20 && i < 60;
      const double x = 0.05 * (still ? 20 : i) + (i >= 60 ? jump : 0.0);
      truth.push_back({i * kSecond / 20, {Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}}});
    }
    return leaps_text(truth);
  };
  EXPECT_EQ(text_of(0.0, false), "");
  EXPECT_NE(text_of(5.0, false)
                .find("jump 1 times from one pose to the next, by up to 5.05 m (3.0 "
                      "s after its start)"),
            std::string::npos)
      << text_of(5.0, false);
  EXPECT_NE(text_of(0.0, true).find("after they stood still for 2.0 s"), std::string::npos)
      << text_of(0.0, true);
}

TEST_F(TrajectoryFiles, DirectionsOfTheCompassAreColumns) {
  for (const char* text :
       {"t,north,east,down\n1.5,2,1,3\n", "# t n e d\n1.5 2 1 3\n",
        "time,north_m,east_m,down_m,roll,pitch,yaw\n1.5,2,1,3,0.1,0.2,0.3\n",
        "t [s];down [mm];east [mm];north [mm]\n1,5;3000;1000;2000\n",
        "t,northing,easting,altitude\n1.5,2,1,-3\n", "t,pos_e,pos_n,pos_u\n1.5,1,2,-3\n"}) {
    const auto read = read_trajectory(file("p.csv", text), {});
    ASSERT_TRUE(read) << text << read.error().message;
    ASSERT_EQ(read->trajectory.size(), 1U) << text;
    EXPECT_FALSE(read->has_attitude);
    EXPECT_NEAR((read->trajectory[0].pose.translation - Eigen::Vector3d(1, 2, -3)).norm(), 0.0,
                1e-12)
        << text;
  }
}

TEST_F(TrajectoryFiles, AnglesWithoutAUnitThatNoRadiansReachAreDegrees) {
  constexpr double kDegree = 0.017453292519943295;
  const auto last_yaw = [&](double first, double rate, double roll, const std::string& unit) {
    std::string text = "t,x,y,z,roll,pitch,yaw" + unit + "\n";
    for (int i = 0; i <= 100; ++i) {
      text += std::to_string(0.1 * i) + ",0,0,0," + std::to_string(roll) + ",0," +
              std::to_string(first + 0.1 * rate * i) + "\n";
    }
    const auto read = read_trajectory(file("a.csv", text), {});
    EXPECT_TRUE(read);
    const Eigen::Matrix3d R = read->trajectory.at(100).pose.R();
    return std::atan2(R(1, 0), R(0, 0));
  };
  EXPECT_NEAR(last_yaw(150.0, 4.0, 0.0, ""), -170.0 * kDegree, 1e-6) << "begins beyond a turn";
  EXPECT_NEAR(last_yaw(0.0, 17.0, 0.0, ""), 170.0 * kDegree, 1e-6) << "turns too fast";
  EXPECT_NEAR(last_yaw(0.0, 0.1, 8.0, ""), 1.0 * kDegree, 0.01) << "rolls beyond a turn";
  EXPECT_NEAR(last_yaw(0.5, 0.7, 0.0, ""), 7.5 - 6.283185307179586, 1e-6) << "unwrapped";
  EXPECT_NEAR(last_yaw(0.0, 0.3, 0.0, ""), 3.0, 1e-6);
  EXPECT_NEAR(last_yaw(10.0, 0.0, 0.0, " [rad]"), 10.0 - 4 * 3.141592653589793, 1e-6);
}

TEST_F(TrajectoryFiles, QuaternionsOfZeroAreNone) {
  const auto read = read_trajectory(file("p.tum", "1 1 2 3 0 0 0 0\n2 4 5 6 0 0 0 0\n"), {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_FALSE(read->has_attitude);
  ASSERT_EQ(read->trajectory.size(), 2U);
  EXPECT_EQ(read->trajectory[1].pose.translation, Eigen::Vector3d(4, 5, 6));
  EXPECT_NE(read->notes.at(0).find("positions alone"), std::string::npos);
  const auto some = read_trajectory(file("p.tum", "1 1 2 3 0 0 0 0\n2 4 5 6 0 0 0 1\n"), {});
  EXPECT_EQ(some->trajectory.size(), 1U);
}

TEST_F(TrajectoryFiles, StampsOfPandasAreReadOrNamed) {
  for (const char* stamp : {"1700000000000000000.0", "1.7e18", "1700000000000.0"}) {
    const auto read =
        read_trajectory(file("p.csv", std::string("t,x,y,z\n") + stamp + ",1,2,3\n"), {});
    ASSERT_TRUE(read) << stamp << read.error().message;
    EXPECT_EQ(read->trajectory.at(0).stamp, 1'700'000'000 * kSecond) << stamp;
  }
  for (const char* header : {"t,x,y,z\n", ""}) {
    const std::string text = std::string(header) + "Tue Nov 14 22:13:20 2023,1,2,3\n";
    EXPECT_NE(message_of(file("p.csv", text))
                  .find("expected a number, or a date as 2023-05-01T12:00:00.5Z, as stamp, found "
                        "'Tue Nov 14 22:13:20 2023'"),
              std::string::npos)
        << message_of(file("p.csv", text));
  }
}

TEST_F(TrajectoryFiles, DatesAreStamps) {
  for (const char* text : {"t,x,y,z\n2023-11-14 22:13:20.125000,1,2,3\n",
                           "2023-11-14T22:13:20.125Z,1,2,3\n", "2023-11-14T22:13:20.125Z 1 2 3\n",
                           "time;x;y;z\n2023-11-14T23:13:20,125+01:00;1,0;2,0;3,0\n"}) {
    const auto read = read_trajectory(file("p.csv", text), {});
    ASSERT_TRUE(read) << text << read.error().message;
    EXPECT_EQ(read->trajectory.at(0).stamp, 1'700'000'000 * kSecond + kSecond / 8) << text;
    EXPECT_NE(read->notes.at(0).find("stamps are dates (ISO 8601)"), std::string::npos);
  }
}

TEST_F(TrajectoryFiles, NumbersThatAreNoneAreNamedAndTheRestIsRead) {
  const std::string tum =
      "1 0 0 0 0 0 0 1\n2 0 nan 0 0 0 0 1\nnan 0 0 0 0 0 0 1\n4 0 0 0 0 0 0 1\n";
  std::string table = tum;
  std::ranges::replace(table, ' ', ',');
  for (const std::string& text : {tum, "t,x,y,z,qx,qy,qz,qw\n" + table}) {
    const int header = text == tum ? 0 : 1;
    const auto read = read_trajectory(file("p.csv", text), {});
    ASSERT_TRUE(read) << text << read.error().message;
    EXPECT_EQ(read->trajectory.size(), 2U);
    const auto noted = [&](const std::string& part) {
      return std::ranges::any_of(read->notes, [&](const std::string& each) {
        return each.find(part) != std::string::npos;
      });
    };
    EXPECT_TRUE(noted("p.csv:" + std::to_string(3 + header) +
                      ": the stamp is NaN (or an empty cell): 1 such line is left out"));
    EXPECT_TRUE(noted("p.csv:" + std::to_string(2 + header) + ": y is NaN"));
    EXPECT_TRUE(noted("1 of 3 poses dropped: 1 not finite"));
  }
}

TEST_F(TrajectoryFiles, NumbersWithoutNamesAreNoOtherColumns) {
  EXPECT_NE(message_of(file("t", "0 1700000001 1 2 3 0 0 0 1\n")).find("t:1: expected 8 columns"),
            std::string::npos);
}

TEST_F(TrajectoryFiles, EmptyCellsAreNoPosition) {
  const auto read = read_trajectory(file("p.csv", "t,x,y,z\n1,1,2,3\n2,,,\n3,4,5,6\n"), {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->trajectory.size(), 2U);
  EXPECT_NE(read->notes.back().find("1 of 3 poses dropped: 1 not finite"), std::string::npos);
}

TEST_F(TrajectoryFiles, WhatIsNoTrajectoryIsNamedAsWhatItIs) {
  const std::string tar = std::string(257, 'a') + "ustar" + std::string(300, '\0');
  for (const char* name : {"x.tum", "x.bag", "x.mcap"}) {
    EXPECT_NE(message_of(file(name, "\n<!DOCTYPE html><html>\n")).find("is a web page"),
              std::string::npos);
    EXPECT_NE(message_of(file(name, "version https://git-lfs.github.com/spec/v1\nsize 1\n"))
                  .find("pointer of Git LFS"),
              std::string::npos);
    EXPECT_NE(message_of(file(name, tar)).find("unpack it with tar"), std::string::npos);
  }
}

TEST_F(TrajectoryFiles, APipeIsRefusedAtOnce) {
  const auto pipe = folder_.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(message_of(pipe.string()).find("expected a regular file"), std::string::npos);
  EXPECT_NE(message_of("/dev/zero").find("expected a regular file"), std::string::npos);
}

TEST_F(TrajectoryFiles, KittiPosesNeedAsManyStamps) {
  const std::string poses = file("p.txt", "1 0 0 4 0 1 0 5 0 0 1 6\n1 0 0 4 0 1 0 5 0 0 1 6\n");
  EXPECT_NE(message_of(poses).find("2 KITTI poses without stamps"), std::string::npos);
  const std::string message = message_of(
      poses,
      {.rules = PoseRules::kStrict, .stamps = {{"times.txt", {0}}, {"the truth", {0, 1, 2}}}});
  EXPECT_NE(message.find("times.txt has 1, the truth has 3"), std::string::npos) << message;
}

TEST_F(TrajectoryFiles, OdometryPosesAndPathsOfABagAreTheSameTrajectory) {
  const std::string run = bag(kEpoch, true);
  for (const char* topic : {"/odom", "/pose", "/path"}) {
    SCOPED_TRACE(topic);
    expect_ten_poses(read_trajectory(run + ":" + topic, {}), kEpoch);
  }
}

TEST_F(TrajectoryFiles, TheTopicIsOptionalWithOneOrAPreferredTopic) {
  expect_ten_poses(read_trajectory(bag(kEpoch, false), {}), kEpoch);
  std::filesystem::remove(folder_.path() / "run.bag");
  const std::string several = bag(kEpoch, true);
  EXPECT_NE(message_of(several).find("several topics with poses"), std::string::npos);
  EXPECT_NE(message_of(several).find("/path (nav_msgs/Path)"), std::string::npos);
  const auto preferred = read_trajectory(several, {.preferred_topic = "/pose"});
  expect_ten_poses(preferred, kEpoch);
  EXPECT_NE(preferred->notes.front().find("/pose chosen of several"), std::string::npos);
}

TEST_F(TrajectoryFiles, AnErrorOfAMissingTopicListsTheExistingOnes) {
  const std::string message = message_of(bag(kEpoch, false) + ":/gps");
  EXPECT_NE(message.find("no topic /gps; there are /odom (nav_msgs/Odometry)"), std::string::npos)
      << message;
}

TEST_F(TrajectoryFiles, WithoutHeaderStampsRecordTimesAreUsed) {
  const auto read = read_trajectory(bag(0, false), {});
  expect_ten_poses(read, kEpoch);
  EXPECT_NE(read->notes.front().find("record times are used"), std::string::npos);
}

TEST_F(TrajectoryFiles, InvalidPosesAreDroppedAndCounted) {
  const auto path = folder_.path() / "poor.bag";
  auto writer = BagWriter::create(path);
  const auto odometry = writer->add_connection("/odom", odometry_type());
  const auto write = [&](Time stamp, double x) {
    const MessageHeader header{0, stamp, "world"};
    const Pose pose{Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}};
    EXPECT_TRUE(
        writer->write(odometry, stamp, odometry_message(header, "imu", {pose, {}, {}}).view()));
  };
  write(kSecond, 1.0);
  write(kSecond, 2.0);
  write(2 * kSecond, std::numeric_limits<double>::quiet_NaN());
  write(3 * kSecond, 3.0);
  ASSERT_TRUE(writer->close());
  const auto truth = read_trajectory(path.string(), {});
  ASSERT_TRUE(truth) << truth.error().message;
  EXPECT_EQ(truth->trajectory.size(), 2U);
  EXPECT_NE(truth->notes.front().find("2 of 4 poses dropped"), std::string::npos);
  const auto estimate = read_trajectory(path.string(), {.rules = PoseRules::kAsGiven});
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->trajectory.size(), 4U);
}

TEST_F(TrajectoryFiles, ATextFileNamedBagIsAnError) {
  const std::string message = message_of(file("text.bag", "1 0 0 0 0 0 0 1\n"));
  EXPECT_NE(message.find("text.bag"), std::string::npos);
  EXPECT_NE(message.find("expected a ROS 1 bag"), std::string::npos) << message;
}

TEST_F(TrajectoryFiles, TheLastTextOfATopicIsRead) {
  const auto path = folder_.path() / "text.bag";
  auto writer = BagWriter::create(path);
  const auto id = writer->add_connection("/aims/waypoint_times", string_type());
  EXPECT_TRUE(writer->write(id, kSecond, string_message("old").view()));
  EXPECT_TRUE(writer->write(id, 2 * kSecond, string_message("point,stamp_s\n").view()));
  ASSERT_TRUE(writer->close());
  const auto text = read_bag_text(path, "/aims/waypoint_times");
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(**text, "point,stamp_s\n");
  const auto none = read_bag_text(path, "/other");
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
}

}  // namespace
}  // namespace aims
