// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"

namespace aims {

// Names that ROS 2 gives to topics and types in DDS: topic /imu/data is rt/imu/data, type
// sensor_msgs/Imu is sensor_msgs::msg::dds_::Imu_ (design.ros2.org, topic and service names).

/// "rt/imu/data" of "/imu/data".
std::string dds_topic(const std::string& topic);

/// "/imu/data" of "rt/imu/data"; nothing for what is no ROS topic, e.g. a service's.
std::optional<std::string> ros_topic(const std::string& dds);

/// "sensor_msgs::msg::dds_::Imu_" of "sensor_msgs/Imu".
std::string dds_type(const std::string& type);

/// "sensor_msgs/Imu" of "sensor_msgs::msg::dds_::Imu_"; nothing for what is no ROS message.
std::optional<std::string> ros_type(const std::string& dds);

/// What publishers promise to their subscribers.
struct OfferedQuality {
  bool reliable = true;
  bool transient_local = true;  ///< late subscribers receive past messages
};

/// The ROS topics that other nodes of a domain publish.
class Discovery {
 public:
  /// Watches from the participant, an entity of DDS, whose own topics are left out.
  static Result<Discovery> create(std::int32_t participant);

  /// Takes over which publishers came and went.
  void update();

  /// Types by topic.
  std::map<std::string, std::string> topics() const;

  struct Offer {
    std::string topic;
    std::string type;
    OfferedQuality quality;
    Time began = 0;  ///< of its node, by its own word; 0: it does not say so
  };
  /// Of those who publish the topic.
  std::vector<Offer> offers_of(const std::string& topic) const;

  /// Topics that several publish, or did since the last call, and how many.
  std::map<std::string, std::size_t> take_doubled();

  /// What all publishers of the topic offer; the least where there are none.
  OfferedQuality quality_of(const std::string& topic) const;

 private:
  std::int32_t reader_ = 0;
  std::array<std::uint8_t, 16> own_{};
  std::map<std::uint64_t, Offer> offers_;       ///< by instance
  std::map<std::string, std::size_t> doubled_;  ///< topics of several, and how many
};

}  // namespace aims
