// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recording_writer.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "recordings/bag/bag_writer.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/messages/ros2_definition.hpp"
#include "recordings/topics/recording_topics.hpp"

namespace aims {
namespace {

struct TopicInfo {
  std::string_view name;
  MessageType (*type)();
  bool latching = false;
};

constexpr TopicInfo kTopics[] = {
    {kScenarioTopic, string_type, true},
    {kStaticTransformsTopic, transforms_type, true},
    {kImuTopic, imu_type},
    {kFastImuTopic, imu_type},
    {kJointStatesTopic, joint_state_type},
    {kFootContactsTopic, foot_contacts_type},
    {kLegOdometryTopic, odometry_type},
    {kLidarTopic, point_cloud_type},
    {kTruthImuTopic, odometry_type},
    {kTruthLidarTopic, odometry_type},
    {kWaypointTimesTopic, string_type, true},
};

/// The motion of a frame fixed to the body at `T_body_frame`, for an odometry message.
OdometryContent motion_of(const BodyMotion& body, const Pose& T_body_frame) {
  const Eigen::Vector3d in_body = body.T_world_body.rotation.conjugate() * body.velocity;
  const Eigen::Vector3d around = body.angular_velocity.cross(T_body_frame.translation);
  const Eigen::Quaterniond to_frame = T_body_frame.rotation.conjugate();
  return {body.T_world_body * T_body_frame, to_frame * (in_body + around),
          to_frame * body.angular_velocity};
}

}  // namespace

RecordingWriter::RecordingWriter(std::unique_ptr<MessageSink> recording, const SensorRig& rig)
    : recording_(std::move(recording)), serialization_(recording_->serialization()), rig_(rig) {
  static_assert(std::size(kTopics) == kTopicCount);
  connections_.fill(-1);
}

Result<RecordingWriter> RecordingWriter::create(const std::filesystem::path& bag,
                                                const SensorRig& rig, std::string_view scenario) {
  auto writer = BagWriter::create(bag);
  if (!writer) return tl::unexpected(writer.error());
  return create(std::make_unique<BagWriter>(std::move(*writer)), rig, scenario);
}

Result<RecordingWriter> RecordingWriter::create(std::unique_ptr<MessageSink> recording,
                                                const SensorRig& rig, std::string_view scenario) {
  RecordingWriter writer(std::move(recording), rig);
  const Serialization serialization = writer.serialization_;
  if (auto ok = writer.write(kScenario, 0, string_message(scenario, serialization)); !ok) {
    return tl::unexpected(ok.error());
  }
  const std::vector<FrameTransform> fixed = {{kImuFrame, kLidarFrame, rig.T_body_lidar},
                                             {kImuFrame, kBaseFrame, rig.T_body_base}};
  if (auto ok = writer.write(kStaticTransforms, 0, transforms_message(0, fixed, serialization));
      !ok) {
    return tl::unexpected(ok.error());
  }
  return writer;
}

Result<std::uint32_t> RecordingWriter::connection(Topic topic) {
  if (connections_[topic] < 0) {
    const TopicInfo& info = kTopics[topic];
    Result<MessageType> type = info.type();
    if (serialization_ == Serialization::kCdr) type = ros2_type(*type);
    if (!type) return tl::unexpected(type.error());
    connections_[topic] = recording_->add_connection(std::string(info.name), *type, info.latching);
  }
  return static_cast<std::uint32_t>(connections_[topic]);
}

MessageHeader RecordingWriter::header(Topic topic, Time stamp, std::string_view frame) {
  return {sequences_[topic]++, stamp, frame};
}

Result<void> RecordingWriter::write(Topic topic, Time record_time, const MessageBytes& message) {
  const auto id = connection(topic);
  if (!id) return tl::unexpected(id.error());
  return recording_->write(*id, std::max<Time>(record_time, 1), message.view());
}

Result<void> RecordingWriter::write_imu(ImuOutput output, Time arrival, const ImuSample& sample) {
  if (sample.stamp < 0) return ++dropped_, Result<void>{};
  const Topic topic = output == ImuOutput::kMain ? kImu : kFastImu;
  return write(topic, arrival,
               imu_message(header(topic, sample.stamp, kImuFrame), sample, serialization_));
}

Result<void> RecordingWriter::write_scan(Time arrival, const LidarScan& scan) {
  if (scan.stamp < 0) return ++dropped_, Result<void>{};
  return write(
      kLidar, arrival,
      cloud_message(header(kLidar, scan.stamp, kLidarFrame), scan, serialization_, cloud_format_));
}

Result<void> RecordingWriter::write_legs(Time arrival, const LegOdometrySample& sample) {
  if (sample.stamp < 0) return ++dropped_, Result<void>{};
  const auto joints = header(kJointStates, sample.stamp, kBaseFrame);
  if (auto ok = write(kJointStates, arrival, joint_state_message(joints, sample, serialization_));
      !ok)
    return ok;
  const auto contacts = header(kFootContacts, sample.stamp, kBaseFrame);
  if (auto ok =
          write(kFootContacts, arrival, foot_contacts_message(contacts, sample, serialization_));
      !ok) {
    return ok;
  }
  return write_leg_odometry(arrival, sample);
}

Result<void> RecordingWriter::write_leg_odometry(Time arrival, const LegOdometrySample& sample) {
  if (sample.stamp < 0) return ++dropped_, Result<void>{};
  const OdometryContent content = {sample.T_odom_base, sample.linear_velocity,
                                   sample.angular_velocity};
  return write(kLegOdometry, arrival,
               odometry_message(header(kLegOdometry, sample.stamp, kOdometryFrame), kBaseFrame,
                                content, serialization_));
}

Result<void> RecordingWriter::write_truth(const BodyMotion& motion) {
  const auto imu = odometry_message(header(kTruthImu, motion.stamp, kWorldFrame), kImuFrame,
                                    motion_of(motion, Pose{}), serialization_);
  if (auto ok = write(kTruthImu, motion.stamp, imu); !ok) return ok;
  const auto lidar = odometry_message(header(kTruthLidar, motion.stamp, kWorldFrame), kLidarFrame,
                                      motion_of(motion, rig_.T_body_lidar), serialization_);
  return write(kTruthLidar, motion.stamp, lidar);
}

Result<void> RecordingWriter::write_waypoint_times(Time arrival, std::string_view csv) {
  return write(kWaypointTimes, arrival, string_message(csv, serialization_));
}

Result<void> RecordingWriter::close() { return recording_->close(); }

}  // namespace aims
