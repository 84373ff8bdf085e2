// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "live/message.hpp"

namespace aims {

/// A node of a network that receives and publishes messages of any type, as bytes. This header
/// needs neither a network's library nor C++20, so that each stays in its own sources.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Whether its messages are CDR, as in ROS 2.
  virtual bool cdr() const = 0;

  /// False once the node was asked to end: Ctrl-C, SIGTERM, SIGHUP, or by the network.
  virtual bool running() const = 0;

  /// Types of the topics that other nodes publish, by topic.
  virtual std::map<std::string, std::string> topics() = 0;

  /// The resolved name of a topic; "~x" is in the node's namespace.
  virtual std::string resolved(const std::string& topic) const = 0;

  /// Subscribes to a topic of that type, unless subscribed already.
  virtual void subscribe(const std::string& topic, const std::string& type) = 0;
  virtual void unsubscribe(const std::string& topic) = 0;

  /// The next message in order of arrival; nothing after `seconds`, or when the node ends.
  virtual std::optional<LiveMessage> wait(double seconds) = 0;

  /// Messages dropped so far, since the node was too slow.
  virtual std::size_t dropped() const = 0;

  /// Messages that the network lost so far, as far as it knows.
  virtual std::size_t lost() const { return 0; }

  /// The longest time for which a cloud may wait from now on [ns].
  virtual void limit_wait(std::int64_t longest) = 0;

  /// What is wrong with the network, one sentence each, since the last call.
  virtual std::vector<std::string> take_problems() { return {}; }

  /// Announces a topic; returns the number to publish with.
  virtual std::size_t advertise(const LiveConnection& connection) = 0;
  /// Whether somebody listens to it.
  virtual bool heard(std::size_t publisher) const = 0;
  virtual void publish(std::size_t publisher, const std::byte* data, std::size_t size) = 0;

 protected:
  Transport() = default;
};

}  // namespace aims
