// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "core/error.hpp"
#include "core/time.hpp"

namespace aims {

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

  /// A type under which the topic is published, other than that; empty: there is none.
  std::string other_type(const std::string& topic, const std::string& type) const;

  /// How many publish the topic.
  std::size_t publishers(const std::string& topic) const;

  /// Topics that several publish, or did since the last call, and how many.
  std::map<std::string, std::size_t> take_doubled();

  /// When the first node that publishes the topic began, by its own word; 0: before all others,
  /// where it does not say so. The end of time where none publishes it.
  Time oldest(const std::string& topic) const;

  /// What all publishers of the topic offer; the least where there are none.
  OfferedQuality quality_of(const std::string& topic) const;

 private:
  struct Offer {
    std::string topic;
    std::string type;
    OfferedQuality quality;
    Time began = 0;  ///< of its node
  };

  std::int32_t reader_ = 0;
  std::array<std::uint8_t, 16> own_{};
  std::map<std::uint64_t, Offer> offers_;       ///< by instance
  std::map<std::string, std::size_t> doubled_;  ///< topics of several, and how many
};

}  // namespace aims
