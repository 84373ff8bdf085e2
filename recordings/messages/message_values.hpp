// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "core/lie.hpp"
#include "core/time.hpp"
#include "recordings/event_counts.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {

/// The stamp of a message's header, or its record time when it has none.
Time header_stamp(const MessageView& message, Time record_time);

/// A vector "x", "y", "z" below `path`, or nothing.
std::optional<Eigen::Vector3d> vector_at(const MessageView& message, std::string_view path);

/// A pose "position", "orientation" below `path`, or nothing. A rotation off unit length is made
/// unit; one that is none becomes the identity and is counted as "pose_without_rotation".
std::optional<Pose> message_pose(const MessageView& message, std::string_view path,
                                 EventCounts& counts);

/// Quaternion "x", "y", "z", "w" below `path`, as recorded, or nothing.
std::optional<Eigen::Quaterniond> quaternion_at(const MessageView& message, std::string_view path);

/// Farther from unit length than rounding explains.
bool is_off_unit(const Eigen::Quaterniond& rotation);

}  // namespace aims
