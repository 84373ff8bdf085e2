// SPDX-License-Identifier: BSD-3-Clause
// Sound messages of robots and LiDARs with some of their bytes changed, left out or cut off.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/files/byte_cursor.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/memory_bag.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/touch.hpp"
#include "tests/recordings/pcap/room_packets.hpp"
#include "tests/recordings/stream/message_fields.hpp"
#include "tests/recordings/stream/robot_messages.hpp"

namespace aims {
namespace {

using test::RobotMessage;
using test::RoomPacket;
using Messages = std::vector<std::vector<std::byte>>;

/// Changes messages as the input says, five bytes each: which message, where, the new byte. Behind
/// its end: the message is cut off there, or left out.
void change(Messages& messages, ByteCursor& input) {
  while (!messages.empty() && input.left() >= 5) {
    std::vector<std::byte>& message = messages[*input.number<std::uint16_t>() % messages.size()];
    const std::size_t at = *input.number<std::uint16_t>();
    const auto value = *input.number<std::uint8_t>();
    if (at < message.size()) {
      message[at] = std::byte{value};
    } else {
      message.resize(message.size() * value / 256);
    }
  }
}

RobotMessage robot_of(std::uint8_t kind) {
  switch (kind % 10) {
    case 0:
      return test::go1_high_state();
    case 1:
      return test::leg_kilo_high_state();
    case 2:
      return test::fusion_portable_high_state();
    case 3:
      return test::feet_high_state();
    case 4:
      return test::go1_low_state();
    case 5:
      return test::a1_low_state();
    case 6:
      return test::anymal_state(test::anymal_joints(), test::anymal_feet());
    case 7:
      return test::actuator_readings();
    case 8:
      return test::spot_feet();
    default:
      return test::humanoid_state();
  }
}

/// A robot that trots on the spot.
test::RobotSample trotting(int number) {
  test::RobotSample sample;
  sample.number = number;
  sample.stamp = kSecond + number * 20 * kMillisecond;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const double phase = 0.3 * number + (leg == 0 || leg == 3 ? 0.0 : 3.14);
    sample.angles.segment<3>(3 * leg) = Eigen::Vector3d(0.0, 0.8, -1.6 + 0.2 * std::sin(phase));
    sample.contact[static_cast<std::size_t>(leg)] = std::sin(phase) < 0.0;
  }
  return sample;
}

void add_imu(MemoryBag& bag) {
  const auto topic = bag.add("/imu", imu_type());
  for (int i = 0; i < 100; ++i) {
    const Time time = kSecond + i * 20 * kMillisecond;
    ImuSample sample;
    sample.stamp = time;
    sample.specific_force = {0.0, 0.0, 9.81};
    bag.write(topic, time, imu_message({0, time, "imu"}, sample).view());
  }
}

/// How a driver's message holds one packet or several.
struct Driver {
  MessageType type;
  bool several = true;
  std::size_t fixed = 0;  ///< size of the array of a packet; 0: variable
  bool stamped = true;
};

Driver driver_of(std::uint8_t kind) {
  const auto scan = [](const std::string& name, const std::string& packet,
                       const std::string& fields) {
    const std::string package = name.substr(0, name.find('/') + 1);
    return MessageType{name, "",
                       "Header header\n" + packet + "[] packets\n" +
                           test::used(package + packet, fields) + test::used_header()};
  };
  if (kind == 0) {
    return {scan("velodyne_msgs/VelodyneScan", "VelodynePacket", "time stamp\nuint8[1206] data\n"),
            true, 1206};
  }
  if (kind == 1) {
    return {scan("hesai_lidar/PandarScan", "PandarPacket", "time stamp\nuint8[] data\n")};
  }
  if (kind == 2) {
    return {scan("rslidar_msgs/rslidarScan", "rslidarPacket", "time stamp\nuint8[1248] data\n"),
            true, 1248};
  }
  return {{"ouster_ros/PacketMsg", "", "uint8[] buf\n"}, false, 0, false};
}

std::vector<RoomPacket> packets_of(std::uint8_t kind) {
  if (kind == 0) return test::vlp16_packets(kSecond, 2);
  if (kind == 1) return test::xt_packets(kSecond, 1, 16);
  if (kind == 3) return test::ouster_lidar_packets(kSecond, kSecond, 2);
  auto packets = test::rs16_packets(kSecond, 2);
  packets.insert(packets.begin(), test::rs16_information(kSecond, {}));
  return packets;
}

/// A message of one packet, with a header where the driver has several.
MessageBytes message_of(const Driver& driver, Time time, std::vector<std::byte> packet) {
  MessageBytes out;
  if (driver.several) {
    test::put_header(out, time, "lidar");
    out.length(1);
  }
  if (driver.stamped) out.time(time);
  if (driver.fixed > 0) packet.resize(driver.fixed);
  if (driver.fixed == 0) out.length(packet.size());
  out.append(packet.data(), packet.size());
  return out;
}

constexpr std::array<const char*, kLegCount> kLegTopics = {"fl", "fr", "rl", "rr"};

/// The joints of a leg as sensor_msgs/JointState.
MessageBytes leg_joints(int leg, Time stamp, const test::RobotSample& sample) {
  MessageBytes out;
  test::put_header(out, stamp, "base");
  out.length(3);
  for (const char* joint : {"_hip", "_thigh", "_calf"}) {
    out.text(std::string(kLegTopics[static_cast<std::size_t>(leg)]) + joint);
  }
  for (int times = 0; times < 3; ++times) {
    out.array(std::vector<double>(&sample.angles[3 * leg], &sample.angles[3 * leg] + 3));
  }
  return out;
}

/// The same with the load of its foot as a message of its own, which names its leg.
MessageBytes named_leg_state(int leg, Time stamp, const test::RobotSample& sample) {
  MessageBytes out;
  test::put_header(out, stamp, "base");
  out.text(kLegTopics[static_cast<std::size_t>(leg)]);
  for (int times = 0; times < 2; ++times) {
    for (int joint = 0; joint < 3; ++joint) out.put(sample.angles[3 * leg + joint]);
  }
  out.put(sample.contact[static_cast<std::size_t>(leg)] ? 50.0 : 0.0);
  return out;
}

RecordingConfig without_lidar() {
  RecordingConfig config;
  config.topics.lidar = "none";
  return config;
}

}  // namespace

void fuzz_states(std::span<const std::uint8_t> input) {
  ByteCursor cursor(std::as_bytes(input));
  const auto kind = cursor.number<std::uint8_t>();
  if (!kind) return;
  const RobotMessage robot = robot_of(*kind);
  Messages messages;
  for (int i = 0; i < 100; ++i) {
    const auto bytes = robot.encode(trotting(i));
    messages.emplace_back(bytes.view().begin(), bytes.view().end());
  }
  change(messages, cursor);
  MemoryBag bag;
  add_imu(bag);
  const auto topic = bag.add("/state", robot.type);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    bag.write(topic, kSecond + static_cast<Time>(i) * 20 * kMillisecond, messages[i]);
  }
  touch_recording(MemoryFile(bag.bytes()).path(), false, without_lidar());
}

void fuzz_legs(std::span<const std::uint8_t> input) {
  ByteCursor cursor(std::as_bytes(input));
  const auto first = cursor.number<std::uint8_t>();
  if (!first) return;
  const bool one_topic = (*first & 1U) != 0, stamped = (*first & 2U) != 0;
  const int batch = 1 + *first / 4 % 8;
  MemoryBag bag;
  add_imu(bag);
  const MessageType state = {"my_msgs/Leg", "",
                             "Header header\nstring leg\nfloat64[3] q\nfloat64[3] dq\n"
                             "float64 load\n" +
                                 test::used_header()};
  std::vector<std::uint32_t> topics;
  for (const char* leg : kLegTopics) {
    if (one_topic && !topics.empty()) {
      topics.push_back(topics.front());
    } else {
      topics.push_back(one_topic ? bag.add("/legs", state)
                                 : bag.add(std::string("/") + leg + "/joints", joint_state_type()));
    }
  }
  const auto contacts = bag.add("/foot_contacts", foot_contacts_type());
  Messages messages;
  for (int i = 0; i < 100; ++i) {
    const test::RobotSample sample = trotting(i);
    for (int leg = 0; leg < kLegCount; ++leg) {
      const Time stamp = stamped ? sample.stamp : 0;
      const auto bytes =
          one_topic ? named_leg_state(leg, stamp, sample) : leg_joints(leg, stamp, sample);
      messages.emplace_back(bytes.view().begin(), bytes.view().end());
    }
  }
  change(messages, cursor);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const int number = static_cast<int>(i) / kLegCount;
    const Time time = trotting(number / batch * batch + batch).stamp;
    bag.write(topics[i % kLegCount], time, messages[i]);
    LegOdometrySample feet;
    feet.contact = trotting(number).contact;
    if (!one_topic && i % kLegCount == 0) {
      bag.write(contacts, time, foot_contacts_message({0, time, "base"}, feet).view());
    }
  }
  touch_recording(MemoryFile(bag.bytes()).path(), false, without_lidar());
}

void fuzz_packets(std::span<const std::uint8_t> input) {
  ByteCursor cursor(std::as_bytes(input));
  const auto any = cursor.number<std::uint8_t>();
  if (!any) return;
  const auto kind = static_cast<std::uint8_t>(*any % 4);
  const std::vector<RoomPacket> packets = packets_of(kind);
  Messages payloads;
  for (const RoomPacket& each : packets) payloads.push_back(each.payload);
  const std::string metadata = test::ouster_metadata_text();
  if (kind == 3) {
    const auto bytes = std::as_bytes(std::span(metadata));
    payloads.emplace_back(bytes.begin(), bytes.end());
  }
  change(payloads, cursor);
  MemoryBag bag;
  add_imu(bag);
  const Driver driver = driver_of(kind);
  if (kind == 3) {
    MessageBytes text;
    text.text(
        std::string(reinterpret_cast<const char*>(payloads.back().data()), payloads.back().size()));
    bag.write(bag.add("/metadata", string_type()), kSecond, text.view());
  }
  const auto topic = bag.add("/lidar_packets", driver.type);
  for (std::size_t i = 0; i < packets.size(); ++i) {
    bag.write(topic, packets[i].time, message_of(driver, packets[i].time, payloads[i]).view());
  }
  touch_recording(MemoryFile(bag.bytes()).path(), false);
}

}  // namespace aims
