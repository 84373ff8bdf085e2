// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "core/error.hpp"
#include "core/measurements.hpp"
#include "recordings/bag/message_sink.hpp"
#include "recordings/messages/message_bytes.hpp"
#include "recordings/messages/message_encoding.hpp"

namespace aims {

/// The true motion of the body at an instant.
struct BodyMotion {
  Time stamp = 0;
  Pose T_world_body;                                           ///< body = IMU frame
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< of the body, in world [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< in body axes [rad/s]
};

/// Which of the two outputs of the IMU a sample comes from.
enum class ImuOutput { kMain, kFast };

/// Writes sensor data and the truth as a recording with the topics of
/// `recordings/topics/recording_topics.hpp`. Messages with a negative time are dropped and counted,
/// since ROS cannot represent them; record time 0 becomes 1 ns, since ROS uses 0 for "never".
class RecordingWriter {
 public:
  /// `scenario` is stored as text on `kScenarioTopic`. Error when it cannot be written.
  static Result<RecordingWriter> create(std::unique_ptr<MessageSink> recording,
                                        const SensorRig& rig, std::string_view scenario);
  /// The same as a new ROS 1 bag; error when the file exists.
  static Result<RecordingWriter> create(const std::filesystem::path& bag, const SensorRig& rig,
                                        std::string_view scenario);

  /// How scans are laid out from now on.
  void set_cloud_format(const CloudFormat& format) { cloud_format_ = format; }

  Result<void> write_imu(ImuOutput output, Time arrival, const ImuSample& sample);
  Result<void> write_scan(Time arrival, const LidarScan& scan);
  /// Joint states, contacts, then odometry, with the same record time.
  Result<void> write_legs(Time arrival, const LegOdometrySample& sample);
  /// Odometry alone, of a robot that reports neither joints nor contacts.
  Result<void> write_leg_odometry(Time arrival, const LegOdometrySample& sample);
  /// The truth of the IMU's and the LiDAR's frame.
  Result<void> write_truth(const BodyMotion& motion);
  /// The waypoint times, as in waypoint_times.csv.
  Result<void> write_waypoint_times(Time arrival, std::string_view csv);
  Result<void> close();

  int dropped() const { return dropped_; }

 private:
  /// The topics, in the order in which they are announced.
  enum Topic : std::size_t {
    kScenario,
    kStaticTransforms,
    kImu,
    kFastImu,
    kJointStates,
    kFootContacts,
    kLegOdometry,
    kLidar,
    kTruthImu,
    kTruthLidar,
    kWaypointTimes,
    kTopicCount,
  };

  RecordingWriter(std::unique_ptr<MessageSink> recording, const SensorRig& rig);
  Result<std::uint32_t> connection(Topic topic);
  MessageHeader header(Topic topic, Time stamp, std::string_view frame);
  Result<void> write(Topic topic, Time record_time, const MessageBytes& message);

  std::unique_ptr<MessageSink> recording_;
  Serialization serialization_;
  SensorRig rig_;
  CloudFormat cloud_format_;
  std::array<std::int64_t, kTopicCount> connections_;  ///< -1: not announced yet
  std::array<std::uint32_t, kTopicCount> sequences_{};
  int dropped_ = 0;
};

}  // namespace aims
