// SPDX-License-Identifier: BSD-3-Clause
// Packets of a LiDAR in a room, as messages of a bag; the oracle is the room.
#include "recordings/source/packet_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "recordings/messages/message_types.hpp"
#include "recordings/source/recording_file.hpp"
#include "tests/recordings/pcap/room_packets.hpp"
#include "tests/recordings/stream/message_fields.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::Recording;
using test::RobotRecording;
using test::RoomPacket;

constexpr Time kBegin = 1'700'000'123 * kSecond;
constexpr double kDegree = std::numbers::pi / 180.0;

/// How a driver's message holds packets.
struct Driver {
  std::string type, packet_type, packet_fields;
  std::size_t fixed = 0;  ///< size of the array of a packet; 0: variable
  bool sized = false;     ///< a field behind it has its used size
};

const Driver kVelodyne = {"velodyne_msgs/VelodyneScan", "VelodynePacket",
                          "time stamp\nuint8[1206] data\n", 1206};
const Driver kGeneralPandar = {"hesai_lidar/PandarScan", "PandarPacket",
                               "time stamp\nuint8[] data\nuint32 size\n", 0, true};
const Driver kPandar = {"pandar_msgs/PandarScan", "PandarPacket",
                        "time stamp\nuint8[1500] data\nuint32 size\n", 1500, true};
const Driver kUdpFrame = {"hesai_ros_driver/UdpFrame", "UdpPacket",
                          "time stamp\nuint8[] data\nuint32 size\n", 0, true};

const Driver kRobosense = {"rslidar_msgs/rslidarScan", "rslidarPacket",
                           "time stamp\nuint8[1248] data\n", 1248};

class Packets : public test::RecordingTest {
 protected:
  /// Messages of `each` packets.
  static void add(RobotRecording& robot, const Driver& driver,
                  const std::vector<RoomPacket>& packets, std::size_t each) {
    const std::string package = driver.type.substr(0, driver.type.find('/') + 1);
    const MessageType type = {driver.type, "",
                              "Header header\n" + driver.packet_type + "[] packets\n" +
                                  test::used(package + driver.packet_type, driver.packet_fields) +
                                  test::used_header()};
    for (std::size_t first = 0; first < packets.size(); first += each) {
      const std::size_t last = std::min(first + each, packets.size());
      MessageBytes out;
      test::put_header(out, packets[first].time, "lidar");
      out.length(last - first);
      for (std::size_t i = first; i < last; ++i) {
        std::vector<std::byte> data = packets[i].payload;
        out.time(packets[i].time);
        if (driver.fixed > 0) data.resize(driver.fixed);
        if (driver.fixed == 0) out.length(data.size());
        out.append(data.data(), data.size());
        if (driver.sized) out.put(static_cast<std::uint32_t>(packets[i].payload.size()));
      }
      robot.add("/packets", type, packets[last - 1].time, out);
    }
  }

  Recording read(const Driver& driver, const std::vector<RoomPacket>& packets, std::size_t each) {
    const auto file = folder_.path() / (driver.type.substr(0, 4) + driver.packet_type + ".bag");
    std::filesystem::remove(file);
    RobotRecording robot(file);
    robot.add_transforms(test::kMounted);
    robot.add_imu(kBegin, 20);
    add(robot, driver, packets, each);
    robot.close();
    return test::read_recording(file);
  }
};

void expect_on_walls(const LidarScan& scan) {
  for (const LidarPoint& point : scan.points) {
    double nearest = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double off = std::abs(point.position[axis]) - test::kRoom[axis];
      nearest = std::min(nearest, std::abs(off));
    }
    EXPECT_LT(nearest, 0.004) << point.position.transpose();
  }
}

/// Difference of an angle from another [deg].
double off_by(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

TEST_F(Packets, OfAVelodyneBecomeScansOfTheRoom) {
  const Recording recording = read(kVelodyne, test::vlp16_packets(kBegin, 3), 76);
  ASSERT_EQ(recording.error, "");
  EXPECT_EQ(recording.setup.topics.lidar, "/packets/points");
  const auto scans = test::scans_of(recording.deliveries);
  ASSERT_EQ(scans.size(), 3U);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const LidarScan& scan = *scans[i];
    EXPECT_NEAR(static_cast<double>(scan.points.size()), 16 * 0.1 / 55.296e-6, 400.0);
    EXPECT_NEAR(to_seconds(scan.stamp - kBegin), 0.1 * static_cast<double>(i), 2e-4);
    expect_on_walls(scan);
    for (const LidarPoint& point : scan.points) {
      const double time = to_seconds(scan.stamp + point.time_offset_ns - kBegin);
      const double azimuth = std::atan2(-point.position.y(), point.position.x()) / kDegree;
      EXPECT_LT(off_by(azimuth, 3600.0 * time), 0.05);
      const double across = std::hypot(point.position.x(), point.position.y());
      EXPECT_NEAR(std::atan2(point.position.z(), across) / kDegree, -15.0 + 2.0 * point.ring, 0.3);
    }
  }
}

TEST_F(Packets, ThatAreSentTwiceOrLateChangeNoScan) {
  std::vector<RoomPacket> packets = test::vlp16_packets(kBegin, 3);
  std::vector<RoomPacket> twice;
  for (const RoomPacket& each : packets) twice.insert(twice.end(), 2, each);
  EXPECT_EQ(test::scans_of(read(kVelodyne, twice, 152).deliveries).size(), 3U);
  std::swap(packets[20], packets[21]);
  const Recording late = read(kVelodyne, packets, 76);
  const auto scans = test::scans_of(late.deliveries);
  ASSERT_EQ(scans.size(), 3U);
  expect_on_walls(*scans[0]);
}

TEST_F(Packets, ThatGoOnceAroundFromAnywhereAreOneScan) {
  const std::vector<RoomPacket> packets = test::vlp16_packets(kBegin, 3);
  const std::size_t turn = packets.size() / 3, from = turn / 4;
  const auto cut = [&](std::size_t count) {
    const auto begin = packets.begin() + static_cast<std::ptrdiff_t>(from);
    const std::vector<RoomPacket> some(begin, begin + static_cast<std::ptrdiff_t>(count));
    return test::scans_of(read(kVelodyne, some, count).deliveries);
  };
  EXPECT_TRUE(cut(turn - 3).empty()) << "a gap of about 14 degrees";
  for (const std::size_t count : {turn + 2, turn + turn / 2}) {
    const auto scans = cut(count);
    ASSERT_EQ(scans.size(), 1U) << count;
    expect_on_walls(*scans[0]);
    EXPECT_NEAR(static_cast<double>(scans[0]->points.size()), 16 * 0.1 / 55.296e-6, 400.0);
    std::array<int, 36> sectors{};
    for (const LidarPoint& point : scans[0]->points) {
      EXPECT_GE(point.time_offset_ns, 0);
      const double azimuth = std::atan2(point.position.y(), point.position.x()) / kDegree;
      ++sectors.at(static_cast<std::size_t>(std::min(35.0, (azimuth + 180.0) / 10.0)));
    }
    EXPECT_GT(*std::ranges::min_element(sectors), 700) << "of about 800 each";
    EXPECT_LT(*std::ranges::max_element(sectors), 900);
  }
}

TEST_F(Packets, OfOtherVelodynesBecomeScansOfTheRoom) {
  for (const test::VelodyneBeams& beams : {test::hdl32e(), test::vlp32c(), test::puck_hi_res()}) {
    SCOPED_TRACE(static_cast<int>(beams.code));
    const Recording recording = read(kVelodyne, test::velodyne_packets(kBegin, 3, beams), 76);
    ASSERT_EQ(recording.error, "");
    const auto scans = test::scans_of(recording.deliveries);
    ASSERT_EQ(scans.size(), 3U);
    std::vector<double> sorted = beams.elevation;
    std::ranges::sort(sorted);
    const auto lasers = static_cast<double>(sorted.size());
    for (const auto& scan : scans) {
      EXPECT_NEAR(static_cast<double>(scan->points.size()), lasers * 0.1e6 / beams.cycle, 900.0);
      expect_on_walls(*scan);
      for (const LidarPoint& point : scan->points) {
        const double time = to_seconds(scan->stamp + point.time_offset_ns - kBegin);
        const double azimuth = std::atan2(-point.position.y(), point.position.x()) / kDegree;
        const double across = std::hypot(point.position.x(), point.position.y());
        const double up = std::atan2(point.position.z(), across) / kDegree;
        EXPECT_NEAR(up, sorted.at(point.ring), 0.01);
        const auto laser = std::ranges::find_if(
            beams.elevation, [&](double each) { return std::abs(each - up) < 0.02; });
        ASSERT_NE(laser, beams.elevation.end());
        const double ahead = beams.ahead[static_cast<std::size_t>(laser - beams.elevation.begin())];
        EXPECT_LT(off_by(azimuth, 3600.0 * time + ahead), 0.05);
      }
    }
  }
}

TEST_F(Packets, OfAHesaiBecomeScansOfTheRoom) {
  for (const Driver& driver : {kGeneralPandar, kPandar, kUdpFrame}) {
    SCOPED_TRACE(driver.type);
    const Recording recording = read(driver, test::xt_packets(kBegin, 3), 250);
    ASSERT_EQ(recording.error, "");
    const auto scans = test::scans_of(recording.deliveries);
    ASSERT_EQ(scans.size(), 3U);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const LidarScan& scan = *scans[i];
      EXPECT_EQ(scan.points.size(), 32U * 2000);
      EXPECT_EQ(scan.stamp, kBegin + static_cast<Time>(i) * kSecond / 10 + 3'280 + 280);
      expect_on_walls(scan);
      for (const LidarPoint& point : scan.points) {
        const double time = to_seconds(scan.stamp + point.time_offset_ns - kBegin - 3'280);
        const double azimuth = std::atan2(point.position.x(), point.position.y()) / kDegree;
        EXPECT_LT(off_by(azimuth, 3600.0 * time), 1e-3);
        const double across = std::hypot(point.position.x(), point.position.y());
        EXPECT_NEAR(std::atan2(point.position.z(), across) / kDegree, -16.0 + point.ring, 1e-3);
      }
    }
  }
}

TEST_F(Packets, OfAHesaiWithSixteenLasersHaveEverySecondElevation) {
  const Recording recording = read(kUdpFrame, test::xt_packets(kBegin, 2, 16), 250);
  ASSERT_EQ(recording.error, "");
  const auto scans = test::scans_of(recording.deliveries);
  ASSERT_EQ(scans.size(), 2U);
  expect_on_walls(*scans[0]);
  for (const LidarPoint& point : scans[0]->points) {
    const double across = std::hypot(point.position.x(), point.position.y());
    EXPECT_NEAR(std::atan2(point.position.z(), across) / kDegree, -15.0 + 2.0 * point.ring, 1e-3);
  }
}

void expect_rs16_scan(const LidarScan& scan, double tilt) {
  expect_on_walls(scan);
  for (const LidarPoint& point : scan.points) {
    const double time = to_seconds(scan.stamp + point.time_offset_ns - kBegin);
    const double azimuth = std::atan2(-point.position.y(), point.position.x()) / kDegree;
    EXPECT_LT(off_by(azimuth, 3600.0 * time), 0.02);
    const double across = std::hypot(point.position.x(), point.position.y()) - 0.03825;
    EXPECT_NEAR(std::atan2(point.position.z(), across) / kDegree, -15.0 + 2.0 * point.ring + tilt,
                1e-3);
  }
}

TEST_F(Packets, OfARobosenseBecomeScansOfTheRoom) {
  for (const bool dual : {false, true}) {
    SCOPED_TRACE(dual);
    const Recording recording = read(kRobosense, test::rs16_packets(kBegin, 3, {dual}), 84);
    ASSERT_EQ(recording.error, "");
    EXPECT_EQ(recording.setup.topics.lidar, "/packets/points");
    const auto scans = test::scans_of(recording.deliveries);
    ASSERT_EQ(scans.size(), 3U);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      EXPECT_NEAR(static_cast<double>(scans[i]->points.size()), 16 * 0.1 / 55.5e-6, 64.0);
      EXPECT_NEAR(to_seconds(scans[i]->stamp - kBegin), 0.1 * static_cast<double>(i), 2e-4);
      expect_rs16_scan(*scans[i], 0.0);
    }
  }
}

TEST_F(Packets, OfARobosenseHaveTheElevationsOfItsInformation) {
  const test::Rs16 sensor = {.tilt = 0.5};
  RobotRecording robot(bag());
  robot.add_imu(kBegin, 20);
  const MessageType type = {"rslidar_msgs/rslidarPacket", "", "time stamp\nuint8[1248] data\n"};
  const RoomPacket information = test::rs16_information(kBegin, sensor);
  MessageBytes out;
  out.time(kBegin);
  out.append(information.payload.data(), information.payload.size());
  robot.add("/packets_difop", type, kBegin - 1, out);
  add(robot, kRobosense, test::rs16_packets(kBegin, 2, sensor), 84);
  robot.close();
  const Recording recording = test::read_recording(bag());
  ASSERT_EQ(recording.error, "");
  const auto scans = test::scans_of(recording.deliveries);
  ASSERT_EQ(scans.size(), 2U);
  for (const auto& scan : scans) expect_rs16_scan(*scan, sensor.tilt);
}

TEST_F(Packets, OfAnotherRobosenseAreNamed) {
  auto packets = test::rs16_packets(kBegin, 1);
  for (RoomPacket& each : packets) each.payload[30] = std::byte{2};
  const std::string error = read(kRobosense, packets, 84).error;
  EXPECT_NE(error.find("packets of an RS-LiDAR-32 (0x02); read are those of an RS-LiDAR-16"),
            std::string::npos)
      << error;
}

TEST_F(Packets, OfAnotherModelAreNamed) {
  auto packets = test::xt_packets(kBegin, 1);
  for (RoomPacket& each : packets) {
    each.payload[2] = std::byte{3};
    each.payload[6] = std::byte{64};
  }
  const std::string error = read(kUdpFrame, packets, 250).error;
  EXPECT_NE(error.find("topic '/packets': packets of a Hesai QT64 with 1080 bytes; read are"),
            std::string::npos)
      << error;
}

class OusterPackets : public Packets {
 protected:
  static constexpr Time kClock = 55 * kSecond;

  void record(RobotRecording& robot, bool metadata) {
    const MessageType type = {"ouster_ros/PacketMsg", "", "uint8[] buf\n"};
    const auto put = [&](const std::string& topic, const RoomPacket& packet) {
      MessageBytes out;
      out.array(packet.payload);
      robot.add(topic, type, packet.time, out);
    };
    if (metadata) {
      MessageBytes text;
      text.text(test::ouster_metadata_text());
      robot.add("/os_node/metadata", string_type(), kBegin, text);
    }
    for (const auto& each : test::ouster_lidar_packets(kBegin, kClock, 4)) {
      put("/os_node/lidar_packets", each);
    }
    for (const auto& each : test::ouster_imu_packets(kBegin, kClock, 40)) {
      put("/os_node/imu_packets", each);
    }
    robot.close();
  }
};

TEST_F(OusterPackets, BecomeScansImuAndFrames) {
  RobotRecording robot(bag());
  record(robot, true);
  const Recording recording = test::read_recording(bag());
  ASSERT_EQ(recording.error, "");
  EXPECT_EQ(recording.setup.topics.lidar, "/os_node/lidar_packets/points");
  EXPECT_EQ(recording.setup.topics.imu, "/os_node/imu_packets/imu");
  const auto scans = test::scans_of(recording.deliveries);
  ASSERT_EQ(scans.size(), 4U);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i]->stamp, kClock + static_cast<Time>(i) * kSecond / 10);
    EXPECT_EQ(scans[i]->points.size(), 16U * 512);
    expect_on_walls(*scans[i]);
    for (const LidarPoint& point : scans[i]->points) EXPECT_LT(point.ring, 16);
  }
  const auto imu = test::imu_of(recording.deliveries);
  ASSERT_EQ(imu.size(), 40U);
  EXPECT_EQ(imu[3].stamp, kClock + 30 * kMillisecond);
  EXPECT_NEAR(imu[3].specific_force.z(), 0.8 * 9.80665, 1e-5);
  const Pose& T_body_lidar = recording.setup.rig.T_body_lidar;
  EXPECT_LT((T_body_lidar.translation - Eigen::Vector3d(-0.006253, 0.011775, 0.028535)).norm(),
            1e-6);
  EXPECT_NEAR(std::abs(yaw_of(T_body_lidar.rotation)), std::numbers::pi, 1e-6);
}

TEST_F(OusterPackets, WithoutMetadataAreAnErrorThatNamesIt) {
  RobotRecording robot(bag());
  record(robot, false);
  const std::string error = test::read_recording(bag()).error;
  EXPECT_NE(error.find("topic '/os_node/lidar_packets' holds packets of an Ouster: expected its "
                       "metadata"),
            std::string::npos)
      << error;
  auto source = open_recording(bag());
  ASSERT_TRUE(source);
  EXPECT_FALSE(decode_packets(*source));
  EXPECT_TRUE((*source)->next().has_value()) << "the source is unchanged";
}

TEST_F(Packets, AreNotChosenWhereACloudIsRecorded) {
  RobotRecording robot(bag());
  robot.add_imu(kBegin, 20);
  robot.add_clouds(kBegin, 3);
  add(robot, kUdpFrame, test::xt_packets(kBegin, 1), 250);
  robot.close();
  EXPECT_EQ(test::read_recording(bag()).setup.topics.lidar, "/points");
  RecordingConfig config;
  config.topics.lidar = "/packets/points";
  EXPECT_EQ(test::scans_of(test::read_recording(bag(), config).deliveries).size(), 1U);
}

}  // namespace
}  // namespace aims
