// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "recordings/bag/message_source.hpp"

namespace aims {

/// Where a recording holds gyro and accelerometer on a topic each, told by their names, as
/// sensor_msgs/Imu (RealSense: /camera/gyro/sample, /camera/accel/sample) or
/// geometry_msgs/Vector3Stamped, replaces `source` by one that also has both as sensor_msgs/Imu on
/// GYRO_TOPIC/imu: a sample per gyro's, the specific force interpolated linearly between those
/// around it. Samples without such a pair within 0.1 s are left out.
void join_split_imu(std::unique_ptr<MessageSource>& source);

}  // namespace aims
