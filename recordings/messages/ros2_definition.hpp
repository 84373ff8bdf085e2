// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/error.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

/// The type as ROS 2 has it, with its definition as `ros2msg`: headers without sequence number,
/// times as builtin_interfaces, field names in lower case, types with their package, constants
/// kept; tf/tfMessage becomes tf2_msgs/TFMessage. Error for a definition that cannot be read, or
/// two fields whose names differ only in case.
Result<MessageType> ros2_type(const MessageType& ros1);

}  // namespace aims
