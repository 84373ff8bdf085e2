// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "live/inbox.hpp"

namespace aims {

/// The name of a node's health on /diagnostics, from that of its topic ~odometry.
inline std::string diagnostics_name(const std::string& odometry) {
  return odometry.substr(1, odometry.rfind('/') - 1) + ": localization";
}

/// Messages of which nothing is read.
struct MissedMessages {
  std::size_t dropped = 0;  ///< since the node was too slow
  std::size_t lost = 0;     ///< by the network

  MissedMessages operator-(const MissedMessages& before) const {
    return {dropped - before.dropped, lost - before.lost};
  }
};

/// A node of a network that receives and publishes messages of any type, as bytes. There is one in
/// a process: it takes the signals that end a program.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Of all messages.
  virtual MessageFormat format() const = 0;

  /// False once the node was asked to end: Ctrl-C, SIGTERM, SIGHUP, or by the network.
  virtual bool running() const;

  /// Whether a node that began before this one publishes the topic.
  virtual bool preceded(const std::string& topic) { return topics().contains(topic); }

  /// Where it listens, for who hears nothing.
  virtual std::string place() const { return ""; }

  /// Types of the topics that other nodes publish, by topic.
  virtual std::map<std::string, std::string> topics() = 0;

  /// The resolved name of a topic; "~x" is in the node's namespace.
  virtual std::string resolved(const std::string& topic) const = 0;

  /// Subscribes to a topic of that type, unless subscribed already.
  virtual void subscribe(const std::string& topic, const std::string& type) = 0;
  virtual void unsubscribe(const std::string& topic) = 0;

  /// The next message in order of arrival; nothing after `seconds`, or when the node ends.
  virtual std::optional<LiveMessage> wait(double seconds);

  /// Messages that were dropped so far, or lost, as far as it knows.
  MissedMessages missed() const { return {inbox_.dropped(), lost()}; }

  /// Topics that several nodes publish, or did since the last call, and how many.
  virtual std::map<std::string, std::size_t> take_doubled() { return {}; }

  /// The longest time for which a cloud may wait from now on.
  void limit_wait(Duration longest) { inbox_.limit_wait(longest); }

  /// What is wrong with the network, one sentence each, since the last call.
  std::vector<std::string> take_problems();

  /// Announces a topic; returns the number to publish with. Late subscribers receive the last
  /// message of a latching one.
  virtual std::size_t advertise(const std::string& topic, const MessageType& type,
                                bool latching) = 0;
  /// Whether somebody listens to it.
  virtual bool heard(std::size_t publisher) const = 0;
  virtual void publish(std::size_t publisher, std::span<const std::byte> data) = 0;

 protected:
  Transport();

  virtual std::size_t lost() const { return 0; }

  /// Keeps a problem for `take_problems`; each once.
  void tell(std::string problem);

  Inbox inbox_;

 private:
  std::mutex mutex_;            ///< of what follows
  std::set<std::string> told_;  ///< problems
  std::vector<std::string> problems_;
};

}  // namespace aims
