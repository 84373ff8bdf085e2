// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>
#include <vector>

#include "core/lie.hpp"
#include "core/measurements.hpp"
#include "core/time.hpp"
#include "recordings/event_counts.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {

/// The stamp of a message's header, or its own one, or nothing.
std::optional<Time> recorded_stamp(const MessageView& message);

/// The same, or its record time when it has none.
Time header_stamp(const MessageView& message, Time record_time);

/// A vector "x", "y", "z" below `path`, or nothing.
std::optional<Eigen::Vector3d> vector_at(const MessageView& message, std::string_view path);

/// The numbers of an array, bytes too. "a[].b" is the field b of each entry of a. Nothing where a
/// field is absent or of another kind.
std::optional<std::vector<double>> numbers_at(const MessageView& message, std::string_view path);

/// The texts of an array, or of a field of each entry, by the same paths.
std::optional<std::vector<std::string_view>> texts_at(const MessageView& message,
                                                      std::string_view path);

/// The points of an array: three numbers each, or "x", "y", "z" of each entry ("a[]") or of a field
/// of it ("a[].b").
std::optional<std::vector<Eigen::Vector3d>> points_at(const MessageView& message,
                                                      std::string_view path);

/// A pose "position", "orientation" below `path`, or nothing. The quaternion is normalized; a norm
/// outside (0.5, 2) yields the identity and is counted as "pose_without_rotation".
std::optional<Pose> message_pose(const MessageView& message, std::string_view path,
                                 EventCounts& counts);

/// One transform of a tf2_msgs/TFMessage or tf/tfMessage.
struct FrameTransform {
  std::string_view parent;
  std::string_view child;
  Pose T_parent_child;
};

/// The transforms of such a message, at most 1000, up to the first malformed one.
std::vector<FrameTransform> transforms_in(const MessageView& message);

/// Quaternion "x", "y", "z", "w" below `path`, as recorded, or nothing.
std::optional<Eigen::Quaterniond> quaternion_at(const MessageView& message, std::string_view path);

/// Orientation of a sensor_msgs/Imu, normalized: R_world_body of the sensor. None where the first
/// entry of its covariance is -1; a quaternion with a norm outside (0.5, 2), e.g. zero or
/// not finite, is none too and counted as "imu_orientation_invalid".
std::optional<Eigen::Quaterniond> imu_orientation(const MessageView& message, EventCounts& counts);

/// The sample of a sensor_msgs/Imu or of a robot's state (`robot_states`), in the recorded unit;
/// nothing for other messages. Invalid orientations are counted as "imu_orientation_invalid".
std::optional<ImuSample> imu_at(const MessageView& message, Time record_time, EventCounts& counts);

/// Whether the norm differs from 1 by more than rounding.
bool is_off_unit(const Eigen::Quaterniond& rotation);

}  // namespace aims
