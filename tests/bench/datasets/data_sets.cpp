// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/datasets/data_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <utility>
#include <variant>

#include "core/files/tum.hpp"
#include "core/leg_kinematics.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/independent/recording.hpp"
#include "tests/recordings/pcap/room_packets.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_messages.hpp"

namespace aims::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeaderText =
    "\n================================================================================\n"
    "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";
constexpr const char* kPointText =
    "\n================================================================================\n"
    "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n";

MessageType point_stamped_type() {
  return {"geometry_msgs/PointStamped", "c63aecb41bfdfd6b7e1fac37c7cbe7bf",
          std::string("Header header\ngeometry_msgs/Point point\n") + kHeaderText + kPointText};
}

MessageType custom_message_type() {
  return {"livox_ros_driver2/CustomMsg", "e4d6829bdfe657cb6c21a746c86b21a6",
          std::string("Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\n"
                      "uint8[3] rsvd\nCustomPoint[] points\n") +
              kHeaderText +
              "\n================================================================================\n"
              "MSG: livox_ros_driver2/CustomPoint\nuint32 offset_time\nfloat32 x\nfloat32 y\n"
              "float32 z\nuint8 reflectivity\nuint8 tag\nuint8 line\n"};
}

void put_header(MessageBytes& bytes, Time stamp, std::string_view frame) {
  bytes.put(std::uint32_t{0});
  bytes.time(stamp);
  bytes.text(frame);
}

MessageBytes point_message(Time stamp, const Eigen::Vector3d& p) {
  MessageBytes bytes;
  put_header(bytes, stamp, "total_station");
  for (const double each : p) bytes.put(each);
  return bytes;
}

MessageBytes custom_message(Time stamp, const LidarScan& scan) {
  MessageBytes bytes;
  put_header(bytes, stamp, "livox_frame");
  bytes.put(static_cast<std::uint64_t>(stamp));
  bytes.put(static_cast<std::uint32_t>(scan.points.size()));
  for (int i = 0; i < 4; ++i) bytes.put(std::uint8_t{0});
  bytes.length(scan.points.size());
  for (const LidarPoint& each : scan.points) {
    bytes.put(static_cast<std::uint32_t>(each.time_offset_ns));
    for (const float value : each.position) bytes.put(value);
    bytes.put(static_cast<std::uint8_t>(255.0F * each.intensity));
    bytes.put(std::uint8_t{0x10});
    bytes.put(static_cast<std::uint8_t>(each.ring % 4));
  }
  return bytes;
}

/// One bag for all topics, or one for each.
class Bags {
 public:
  Bags(fs::path folder, std::string name, bool per_topic)
      : folder_(std::move(folder)), name_(std::move(name)), per_topic_(per_topic) {
    if (per_topic_) fs::create_directories(folder_ / name_);
  }
  ~Bags() {
    for (auto& [key, writer] : writers_) EXPECT_TRUE(writer->close());
  }

  void write(const std::string& topic, const MessageType& type, Time record_time,
             const MessageBytes& message) {
    auto& writer = writers_[per_topic_ ? topic : ""];
    if (!writer) writer = std::make_unique<BagWriter>(open(topic));
    auto id = ids_.find(topic);
    if (id == ids_.end()) id = ids_.emplace(topic, writer->add_connection(topic, type)).first;
    ASSERT_TRUE(writer->write(id->second, record_time, message.view()));
  }

 private:
  BagWriter open(std::string topic) const {
    std::ranges::replace(topic, '/', '_');
    const fs::path file =
        per_topic_ ? folder_ / name_ / (name_ + topic + ".bag") : folder_ / (name_ + ".bag");
    auto writer = BagWriter::create(file);
    EXPECT_TRUE(writer) << writer.error().message;
    return std::move(*writer);
  }

  fs::path folder_;
  std::string name_;
  bool per_topic_ = false;
  std::map<std::string, std::unique_ptr<BagWriter>> writers_;
  std::map<std::string, std::uint32_t> ids_;
};

/// Of the rows of a scan with misses, which ouster-ros keeps.
CloudFormat format_of(const DataSet& data) {
  CloudFormat format;
  format.layout = data.layout;
  format.lines = 16;
  format.columns = 1800;
  format.column_period_ns = 1e8 / 1800.0;
  return format;
}

/// The scan in the mount that the data set documents, its stamps in its epoch.
LidarScan remounted(LidarScan scan, const Pose& T_new_old) {
  for (LidarPoint& each : scan.points) {
    each.position = (T_new_old * each.position.cast<double>()).cast<float>();
  }
  scan.stamp += kDataEpoch;
  scan.end += kDataEpoch;
  return scan;
}

void write_scan(const LidarScan& scan, const DataSet& data, Time arrival, Bags& bags) {
  const Time stamp = data.stamped_at_end ? scan.end : scan.stamp;
  if (data.custom_message) {
    bags.write(data.lidar_topic, custom_message_type(), arrival, custom_message(stamp, scan));
    return;
  }
  const auto message =
      cloud_message({0, stamp, data.lidar_frame}, scan, Serialization::kRos1, format_of(data));
  bags.write(data.lidar_topic, point_cloud_type(), arrival, message);
}

void write_delivery(const Delivery& each, const DataSet& data, const Pose& T_new_old, Bags& bags) {
  const Time arrival = each.arrival + kDataEpoch;
  if (const auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) {
    write_scan(remounted(**scan, T_new_old), data, arrival, bags);
  } else if (const auto* imu = std::get_if<ImuSample>(&each.measurement)) {
    const Time stamp = imu->stamp + kDataEpoch;
    bags.write(data.imu_topic, imu_type(), arrival, imu_message({0, stamp, data.imu_frame}, *imu));
  } else if (const auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) {
    if (data.odometry_topic.empty()) return;
    const OdometryContent content{legs->T_odom_base, legs->linear_velocity, legs->angular_velocity};
    bags.write(data.odometry_topic, odometry_type(), arrival,
               odometry_message({0, legs->stamp + kDataEpoch, "odom"}, "base", content));
  }
}

/// The feet of a trot under the body as it really moved: those that stand keep their place in the
/// world.
class TrottingFeet {
 public:
  static constexpr double kHalfStep = 0.25, kHeight = 0.28;  // [s], [m]
  static constexpr LegGeometry kGo1 = {0.1881, 0.04675, 0.08, 0.213, 0.213, 0.022};

  explicit TrottingFeet(const Trajectory& truth) : truth_(truth) {}

  static bool stands(int leg, double time) {
    const bool first = std::fmod(time, 2.0 * kHalfStep) < kHalfStep;
    return first == (leg == 0 || leg == 3);
  }

  /// In the base [m].
  Eigen::Vector3d foot(int leg, double time) const {
    const double phase = std::fmod(time, kHalfStep) / kHalfStep;
    const double begin = time - phase * kHalfStep;
    if (stands(leg, time)) return in_base(leg, begin + 0.5 * kHalfStep, time);
    const Eigen::Vector3d last = in_base(leg, begin - 0.5 * kHalfStep, begin);
    const Eigen::Vector3d next = in_base(leg, begin + 1.5 * kHalfStep, begin + kHalfStep);
    const double lift = 0.06 * std::sin(M_PI * phase);
    return (1.0 - phase) * last + phase * next + Eigen::Vector3d(0.0, 0.0, lift);
  }

  JointVector angles(double time) const {
    JointVector q;
    for (int leg = 0; leg < kLegCount; ++leg) {
      q.segment<3>(3 * leg) = leg_angles(leg, foot(leg, time), kGo1);
    }
    return q;
  }

 private:
  Pose body(double time) const {
    const Time stamp = truth_.front().stamp + from_seconds(time);
    return *pose_at(truth_, std::clamp(stamp, truth_.front().stamp, truth_.back().stamp));
  }

  /// The foot that stands below its hip at `middle`, seen from the base at `time`.
  Eigen::Vector3d in_base(int leg, double middle, double time) const {
    Eigen::Vector3d below = hip_in_base(leg, kGo1);
    below.y() += side_of(leg) * kGo1.abduction;
    below.z() -= kHeight;
    return body(time).inverse() * (body(middle) * below);
  }

  const Trajectory& truth_;
};

void write_high_states(const Walked& walked, Bags& bags) {
  const TrottingFeet feet(walked.truth);
  const RobotMessage message = leg_kilo_high_state();
  const Time first = walked.truth.front().stamp;
  const int samples = static_cast<int>((walked.truth.back().stamp - first) / (20 * kMillisecond));
  for (int k = 0; k < samples; ++k) {
    const double time = 0.02 * k + 0.003;  // not at touchdown
    RobotSample sample;
    sample.number = k;
    sample.angles = feet.angles(time);
    sample.rates = (feet.angles(time + 1e-4) - sample.angles) / 1e-4;
    for (int leg = 0; leg < kLegCount; ++leg) {
      sample.contact[static_cast<std::size_t>(leg)] = TrottingFeet::stands(leg, time);
    }
    for (int i = 0; i < 10; ++i) {
      sample.stamp = first + kDataEpoch + (k * 20 + i * 2 + 3) * kMillisecond;
      bags.write("/high_state", message.type, sample.stamp + kMillisecond, message.encode(sample));
    }
  }
}

}  // namespace

Walked walk_of(const fs::path& folder, double length) {
  independent::RecordingOptions options;
  options.length = length;
  options.imu_rate_hz = 200.0;
  const fs::path bag = folder / "walk.bag";
  const auto written = independent::write_recording(options, bag);
  EXPECT_TRUE(written) << written.error().message;
  Walked walked;
  auto reader = RecordingReader::open(bag, {});
  EXPECT_TRUE(reader) << reader.error().message;
  walked.deliveries = read_all(*reader).value();
  walked.T_imu_lidar = reader->setup().rig.T_body_lidar;
  walked.truth = read_tum(folder / "walk.truth.tum").value();
  return walked;
}

void write_sequence(const Walked& walked, const DataSet& data, const std::string& name,
                    const Eigen::Vector3d& p_imu_prism, const fs::path& folder) {
  Bags bags(folder, name, data.bag_per_topic);
  if (data.has_tf) {
    std::vector<FrameTransform> fixed = {
        {data.imu_frame, data.lidar_frame, data.T_imu_lidar},
        {data.imu_frame, "base", independent::rig_of({}).T_body_base}};
    bags.write("/tf_static", transforms_type(), kDataEpoch, transforms_message(kDataEpoch, fixed));
  }
  const Pose T_new_old = data.T_imu_lidar.inverse() * walked.T_imu_lidar;
  for (const Delivery& each : walked.deliveries) write_delivery(each, data, T_new_old, bags);
  if (data.high_state) write_high_states(walked, bags);
  if (data.prism_topic.empty()) return;
  for (const StampedPose& each : walked.truth) {
    const Time stamp = each.stamp + kDataEpoch;
    bags.write(data.prism_topic, point_stamped_type(), stamp,
               point_message(stamp, each.pose * p_imu_prism));
  }
}

void write_ouster_packets(const fs::path& file, int turns) {
  auto writer = BagWriter::create(file);
  ASSERT_TRUE(writer) << writer.error().message;
  const MessageType packet = {"ouster_ros/PacketMsg", "", "uint8[] buf\n"};
  const auto lidar = writer->add_connection("/os_cloud_node/lidar_packets", packet);
  const auto imu = writer->add_connection("/os_cloud_node/imu_packets", packet);
  const auto metadata = writer->add_connection("/os_cloud_node/metadata", string_type());
  MessageBytes text;
  text.text(ouster_metadata_text());
  ASSERT_TRUE(writer->write(metadata, kDataEpoch, text.view()));
  const auto put = [&](std::uint32_t id, const RoomPacket& each) {
    MessageBytes message;
    message.length(each.payload.size());
    message.append(each.payload.data(), each.payload.size());
    ASSERT_TRUE(writer->write(id, each.time, message.view()));
  };
  auto points = ouster_lidar_packets(kDataEpoch, kDataEpoch, turns);
  auto inertial = ouster_imu_packets(kDataEpoch, kDataEpoch, 10 * turns);
  for (RoomPacket& each : inertial) {
    constexpr std::array<float, 6> kStanding = {0.0F, 0.0F, 1.0F,
                                                0.0F, 0.0F, 0.0F};  // [g], [deg/s]
    std::memcpy(each.payload.data() + 3 * sizeof(std::uint64_t), kStanding.data(),
                sizeof(kStanding));
  }
  std::size_t next = 0;
  for (const RoomPacket& each : points) {
    while (next < inertial.size() && inertial[next].time <= each.time) put(imu, inertial[next++]);
    put(lidar, each);
  }
  ASSERT_TRUE(writer->close());
}

}  // namespace aims::test
