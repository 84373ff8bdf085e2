// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/topics/recording_channels.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace aims {

std::string_view name_of(Role role) {
  static constexpr std::array<std::string_view, kRoleCount> kNames = {
      "lidar", "imu", "legs", "joints", "contacts", "truth"};
  return kNames[static_cast<std::size_t>(role)];
}

const std::string& topic_of(const TopicsConfig& topics, Role role) {
  switch (role) {
    case Role::kLidar:
      return topics.lidar;
    case Role::kImu:
      return topics.imu;
    case Role::kLegs:
      return topics.leg_odometry;
    case Role::kJoints:
      return topics.joint_states;
    case Role::kContacts:
      return topics.contacts;
    case Role::kTruth:
      break;
  }
  return topics.truth;
}

Result<RecordingChannels> RecordingChannels::create(const std::filesystem::path& bag,
                                                    std::span<const BagConnection> connections,
                                                    const TopicsConfig& topics) {
  RecordingChannels channels;
  for (const BagConnection& connection : connections) {
    Channel channel;
    channel.connection = &connection;
    channel.state = robot_state_of(connection.type, connection.definition);
    for (std::size_t i = 0; i < kRoleCount; ++i) {
      channel.serves[i] = topic_of(topics, static_cast<Role>(i)) == connection.topic;
    }
    if (std::none_of(channel.serves.begin(), channel.serves.end(),
                     [](bool each) { return each; })) {
      continue;
    }
    auto decoder =
        MessageDecoder::create(connection.type, connection.definition, connection.format);
    if (!decoder) {
      return failure(fmt::format("{}: topic '{}': {}", bag.string(), connection.topic,
                                 decoder.error().message));
    }
    channel.decoder = std::move(*decoder);
    channels.channels_.emplace(connection.id, std::move(channel));
  }
  return channels;
}

const Channel* RecordingChannels::find(const BagMessage& message) const {
  const auto found = channels_.find(message.connection->id);
  return found == channels_.end() ? nullptr : &found->second;
}

const Channel* RecordingChannels::of_topic(const std::string& topic) const {
  const auto found = std::ranges::find_if(
      channels_, [&](const auto& each) { return each.second.connection->topic == topic; });
  return found == channels_.end() ? nullptr : &found->second;
}

std::vector<std::string> RecordingChannels::topics() const {
  std::vector<std::string> topics;
  for (const auto& [id, channel] : channels_) topics.push_back(channel.connection->topic);
  std::sort(topics.begin(), topics.end());
  topics.erase(std::unique(topics.begin(), topics.end()), topics.end());
  return topics;
}

}  // namespace aims
