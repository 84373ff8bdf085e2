// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/bag_reader.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Whether messages of that type are clouds that can be read: PointCloud2 or livox CustomMsg.
bool is_cloud_type(std::string_view type);

/// The topics that a recording is read from; empty where it has none or none is wanted. Errors name
/// the file and list the topics that exist: for a missing topic, one of a wrong type, or several of
/// a fitting type.
Result<TopicsConfig> choose_topics(const std::filesystem::path& bag,
                                   std::span<const BagConnection> connections,
                                   const TopicsConfig& wanted, std::vector<std::string>& notes);

/// Type of the topic, or empty.
std::string_view type_of(std::span<const BagConnection> connections, std::string_view topic);

}  // namespace aims
