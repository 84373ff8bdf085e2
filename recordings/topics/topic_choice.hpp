// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Whether the type is a readable cloud: PointCloud2 or livox CustomMsg.
bool is_cloud_type(std::string_view type);

/// Whether the type holds an IMU: sensor_msgs/Imu or a state of a Unitree robot.
bool is_imu_type(std::string_view type);

/// The topics to read; empty where the recording has none or none is requested. Errors name the
/// file and list the existing topics: for a missing topic, a wrong type, or several suitable ones.
Result<TopicsConfig> choose_topics(const std::filesystem::path& bag,
                                   std::span<const BagConnection> connections,
                                   const TopicsConfig& configured, std::vector<std::string>& notes);

/// The topics that `choose_topics` would read of a recording that it refuses: empty where the
/// choice fails.
TopicsConfig unambiguous_topics(const std::filesystem::path& bag,
                                std::span<const BagConnection> connections,
                                const TopicsConfig& configured);

/// Type of the topic, or empty.
std::string_view type_of(std::span<const BagConnection> connections, std::string_view topic);

}  // namespace aims
