// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros/ros_message.hpp"

namespace aims {

/// A node of a ROS 1 network that takes and gives messages of any type, as bytes. This header knows
/// neither ROS nor C++20, so that roscpp, which does not compile as such, stays in one source.
class RosTransport {
 public:
  /// The arguments that are not ROS's own ("topic:=other", "_parameter:=value"), without the first.
  static std::vector<std::string> own_arguments(int argc, char** argv);

  /// Registers the node. Nothing, and a line in `error`, when there is no master.
  static std::unique_ptr<RosTransport> connect(int argc, char** argv, const std::string& name,
                                               std::string& error);
  ~RosTransport();

  /// False once the node was asked to end: Ctrl-C, SIGTERM, or a word from the master.
  bool running() const;

  /// The node's private parameters, "recording/topics/imu" for ~recording/topics/imu. Lists are
  /// written "[a, b]".
  std::map<std::string, std::string> parameters() const;

  /// Types of all published topics, by topic.
  std::map<std::string, std::string> topics() const;

  /// The name under which the node knows a topic, "~x" within the node's own names.
  std::string resolved(const std::string& topic) const;

  /// From here on takes the messages of a topic; a second time changes nothing.
  void subscribe(const std::string& topic);
  void unsubscribe(const std::string& topic);

  /// The next message in order of arrival; nothing after `seconds`, or when the node ends.
  std::optional<RosMessage> wait(double seconds);

  /// Messages left out so far since the node was too slow for them.
  std::size_t dropped() const;

  /// Announces a topic; yields the number to publish with.
  std::size_t advertise(const RosConnection& connection);
  void publish(std::size_t publisher, const std::byte* data, std::size_t size);

 private:
  struct Impl;
  explicit RosTransport(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
