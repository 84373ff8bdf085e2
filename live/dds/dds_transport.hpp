// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "live/dds/discovery.hpp"
#include "live/dds/raw_type.hpp"
#include "live/transport.hpp"

namespace aims {

struct DdsOptions {
  std::uint32_t domain = 0;
  std::string node = "aims";  ///< namespace of "~"
  /// Arrivals are the times at which `aims_play` sent, those of the record; 0 before it has sent
  /// anything. Else this machine's time of reception.
  bool source_time = false;
  bool keep_all = false;       ///< publishing waits rather than that a subscriber misses anything
  double max_blocking = 0.02;  ///< how long publishing waits for slow subscribers [s]
};

/// A node of a ROS 2 network by CycloneDDS alone, without ROS: names as `dds_topic`, messages
/// as bytes. CYCLONEDDS_URI configures interfaces and discovery. A subscription takes the quality
/// that all publishers of its topic offer: reliable, and with past messages, where all do; so it
/// matches any of them. Publishers are reliable, which matches subscribers of any reliability.
class DdsTransport final : public Transport {
 public:
  static Result<std::unique_ptr<DdsTransport>> connect(const DdsOptions& options);
  ~DdsTransport() override;

  MessageFormat format() const override { return kRos2Format; }
  std::map<std::string, std::string> topics() override;
  bool preceded(const std::string& topic) override;
  std::string place() const override;
  std::string resolved(const std::string& topic) const override;
  void subscribe(const std::string& topic, const std::string& type) override;
  void unsubscribe(const std::string& topic) override;
  std::optional<LiveMessage> wait(double seconds) override;
  std::map<std::string, std::size_t> take_doubled() override { return discovery_.take_doubled(); }
  std::size_t advertise(const std::string& topic, const MessageType& type, bool latching) override;
  bool heard(std::size_t publisher) const override { return subscribers(publisher) > 0; }
  void publish(std::size_t publisher, std::span<const std::byte> data) override;

  /// Subscribers that have found it.
  std::size_t subscribers(std::size_t publisher) const;
  /// As `publish`, with that time of sending, >= 0. False when the subscribers are too slow,
  /// or for what is no message of CDR.
  bool publish_at(std::size_t publisher, Time time, std::span<const std::byte> data);
  /// Waits until all subscribers have all messages, or `seconds`; topics of which one has not.
  std::size_t wait_for_subscribers(double seconds) const;

 private:
  std::size_t lost() const override { return lost_; }

  using Entity = std::int32_t;  ///< of DDS
  /// Number of the last sample of each writer.
  using LastSamples = std::map<std::array<std::byte, 16>, std::uint64_t>;
  /// One topic of which this node receives messages.
  struct Subscription {
    ~Subscription();

    DdsTransport& owner;
    std::shared_ptr<const BagConnection> connection;
    bool reliable = false;
    Entity topic = 0;
    Entity reader = 0;
    std::atomic<bool> refused = false;  ///< a publisher offers less than was asked for
    LastSamples last = {};
  };

  explicit DdsTransport(DdsOptions options) : options_(std::move(options)) {}
  std::unique_ptr<Subscription> open(BagConnection connection, bool reliable,
                                     LastSamples last = {});
  Time arrival_of(Time sent, bool latching);
  void take_samples(Subscription& subscription, Entity reader);
  void count_lost(Subscription& subscription, const SampleOrigin& origin);
  void refuse(Subscription& subscription, std::uint32_t policy);
  void reopen_refused();
  void watch_publishers();
  Entity make_topic(const std::string& topic, const std::string& type) const;

  DdsOptions options_;
  Time began_ = wall_time();
  Entity participant_ = 0;
  Discovery discovery_;
  std::map<std::string, std::unique_ptr<Subscription>> subscriptions_;
  std::vector<Entity> writers_;
  std::chrono::steady_clock::time_point watched_;
  std::atomic<std::size_t> lost_ = 0;
  std::atomic<Time> played_ = 0;  ///< time of sending of what was played last; 0: nothing
};

}  // namespace aims
