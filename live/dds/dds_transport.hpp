// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "live/transport.hpp"

namespace aims {

struct DdsOptions {
  std::uint32_t domain = 0;
  std::string node = "aims";  ///< namespace of "~"
  /// Arrivals are the times at which publishers sent, by their clocks: those of the record for
  /// `aims_play`. Else this machine's time of reception.
  bool source_time = false;
  bool keep_all = false;       ///< publishing waits rather than that a subscriber misses anything
  double max_blocking = 0.02;  ///< how long publishing waits for slow subscribers [s]
};

/// A node of a ROS 2 network by CycloneDDS alone, without ROS: names as `dds_names.hpp`, messages
/// as bytes. CYCLONEDDS_URI configures interfaces and discovery. A subscription takes the quality
/// that all publishers of its topic offer: reliable, and with past messages, where all do; so it
/// matches any of them. Publishers are reliable, which matches subscribers of any reliability.
class DdsTransport final : public Transport {
 public:
  static Result<std::unique_ptr<DdsTransport>> connect(const DdsOptions& options);
  ~DdsTransport() override;

  bool cdr() const override { return true; }
  bool running() const override;
  std::map<std::string, std::string> topics() override;
  std::string resolved(const std::string& topic) const override;
  void subscribe(const std::string& topic, const std::string& type) override;
  void unsubscribe(const std::string& topic) override;
  std::optional<LiveMessage> wait(double seconds) override;
  std::size_t dropped() const override;
  void limit_wait(std::int64_t longest) override;
  std::size_t lost() const override;
  std::vector<std::string> take_problems() override;
  std::size_t advertise(const LiveConnection& connection) override;
  bool heard(std::size_t publisher) const override { return subscribers(publisher) > 0; }
  void publish(std::size_t publisher, const std::byte* data, std::size_t size) override;

  /// As `publish`, with that time of sending, >= 0. False when the subscribers are too slow.
  bool publish_at(std::size_t publisher, std::int64_t time, const std::byte* data,
                  std::size_t size);
  /// Subscribers of a topic that this node publishes.
  std::size_t subscribers(std::size_t publisher) const;
  /// Waits until all subscribers have all messages, or `seconds`; topics of which one has not.
  std::size_t wait_for_subscribers(double seconds) const;

 private:
  struct Impl;
  explicit DdsTransport(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
