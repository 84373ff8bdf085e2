// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include "core/files/byte_cursor.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/fuzz/demand.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/memory_bag.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/touch.hpp"

namespace aims {
namespace {

/// Every kind of message that a recording is read from; topics are named after the types.
std::vector<MessageType> fuzzed_types() {
  const std::string header = "\n" + std::string(80, '=') +
                             "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
  const std::string rule = "\n" + std::string(80, '=') + "\nMSG: ";
  const MessageType livox = {
      "livox_ros_driver/CustomMsg", "",
      "Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
      "CustomPoint[] points\n" +
          header + rule +
          "livox_ros_driver/CustomPoint\n"
          "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\n"
          "uint8 line\n"};
  const MessageType twist = {"geometry_msgs/TwistStamped", "",
                             "Header header\nTwist twist\n" + header + rule +
                                 "geometry_msgs/Twist\nVector3 linear\nVector3 angular\n" + rule +
                                 "geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"};
  return {imu_type(),           point_cloud_type(), odometry_type(), joint_state_type(),
          foot_contacts_type(), transforms_type(),  livox,           twist};
}

/// Ways to read the same bag: legs as odometry, as joints with contacts, as twist; both clouds.
std::vector<RecordingConfig> ways_to_read() {
  RecordingConfig odometry;
  odometry.topics.lidar = "/sensor_msgs/PointCloud2";
  odometry.topics.leg_odometry = "/nav_msgs/Odometry";
  RecordingConfig joints = odometry;
  joints.topics.lidar = "/livox_ros_driver/CustomMsg";
  joints.topics.leg_odometry = "none";
  joints.topics.joint_states = "/sensor_msgs/JointState";
  joints.topics.contacts = "/aims_msgs/FootContacts";
  RecordingConfig twist = odometry;
  twist.topics.leg_odometry = "/geometry_msgs/TwistStamped";
  twist.topics.contacts = "/sensor_msgs/JointState";
  return {odometry, joints, twist};
}

}  // namespace

void fuzz_recording(std::span<const std::uint8_t> input) {
  MemoryBag bag;
  const std::vector<MessageType> types = fuzzed_types();
  for (const MessageType& type : types) bag.add("/" + type.name, type);
  // Each message: topic, time since the last [ms], length, bytes.
  ByteCursor cursor(std::as_bytes(input));
  Time time = kSecond;
  while (cursor.left() >= 4) {
    const auto topic = *cursor.number<std::uint8_t>() % types.size();
    time += *cursor.number<std::uint8_t>() * kMillisecond;
    const std::size_t size = *cursor.number<std::uint16_t>();
    const auto data = cursor.take(std::min(size, cursor.left()));
    bag.write(static_cast<std::uint32_t>(topic), time, *data);
  }
  const MemoryFile file(bag.bytes());
  for (const RecordingConfig& way : ways_to_read()) touch_recording(file.path(), false, way);
}

}  // namespace aims
