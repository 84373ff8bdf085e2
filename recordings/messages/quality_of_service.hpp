// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace aims {

/// The profile under which ROS 2 offers a topic again, as recordings of rosbag2 state it: reliable;
/// `latching`: late subscribers receive the last message.
std::string offered_quality(bool latching);

/// Whether such a text offers the last message to late subscribers.
bool is_transient_local(std::string_view offered_quality);

}  // namespace aims
