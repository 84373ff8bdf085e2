// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "recordings/bag/message_source.hpp"

namespace aims {

/// Where a recording holds its legs one by one (`find_leg_topics`), replaces `source` by one that
/// also has them all in one message: their joints as sensor_msgs/JointState on TOPIC/joints, the
/// loads of their feet as aims_msgs/FootLoads on TOPIC/contacts. Each has the newest sample of each
/// leg, and NaN for a leg that is silent.
void join_single_legs(std::unique_ptr<MessageSource>& source);

}  // namespace aims
