// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/robot_states.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// What a topic is read for; one topic may have several roles.
enum class Role { kLidar, kImu, kLegs, kJoints, kContacts, kTruth };
inline constexpr std::size_t kRoleCount = 6;

/// "lidar", "imu", ...: prefix of the counts.
std::string_view name_of(Role role);

/// The topic of a role.
const std::string& topic_of(const TopicsConfig& topics, Role role);

/// One connection of a bag that is read, with its decoder.
struct Channel {
  const BagConnection* connection = nullptr;
  std::array<bool, kRoleCount> serves{};
  MessageDecoder decoder;
  const StateLayout* state = nullptr;  ///< how the type holds a robot's legs, if it does

  bool is(Role role) const { return serves[static_cast<std::size_t>(role)]; }
};

/// The connections of the chosen topics.
class RecordingChannels {
 public:
  /// Error, naming file and topic, for a message definition that cannot be read.
  static Result<RecordingChannels> create(const std::filesystem::path& bag,
                                          std::span<const BagConnection> connections,
                                          const TopicsConfig& topics);

  const Channel* find(const BagMessage& message) const;
  /// The first channel of a topic; null: none.
  const Channel* of_topic(const std::string& topic) const;
  std::vector<std::string> topics() const;

 private:
  std::map<std::uint32_t, Channel> channels_;
};

}  // namespace aims
