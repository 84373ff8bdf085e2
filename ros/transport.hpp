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

/// A node of a ROS 1 network that receives and publishes messages of any type, as bytes. This
/// header needs neither ROS nor C++20, so that roscpp, which is not C++20, stays in one source.
class RosTransport {
 public:
  /// The arguments without those of ROS ("topic:=other", "_parameter:=value") and without the
  /// program's name.
  static std::vector<std::string> own_arguments(int argc, char** argv);

  /// Registers the node. Without a master: nullptr, and a line in `error`.
  static std::unique_ptr<RosTransport> connect(int argc, char** argv, const std::string& name,
                                               std::string& error);
  ~RosTransport();

  /// False once the node was asked to end: Ctrl-C, SIGTERM, or by the master.
  bool running() const;

  /// The node's private parameters, "recording/topics/imu" for ~recording/topics/imu. Lists are
  /// formatted "[a, b]".
  std::map<std::string, std::string> parameters() const;

  /// Types of all published topics, by topic.
  std::map<std::string, std::string> topics() const;

  /// The resolved name of a topic; "~x" is in the node's namespace.
  std::string resolved(const std::string& topic) const;

  /// Subscribes to a topic, unless subscribed already.
  void subscribe(const std::string& topic);
  void unsubscribe(const std::string& topic);

  /// The next message in order of arrival; nothing after `seconds`, or when the node ends.
  std::optional<RosMessage> wait(double seconds);

  /// Messages dropped so far, since the node was too slow.
  std::size_t dropped() const;

  /// Announces a topic; returns the number to publish with.
  std::size_t advertise(const RosConnection& connection);
  void publish(std::size_t publisher, const std::byte* data, std::size_t size);

 private:
  struct Impl;
  explicit RosTransport(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
