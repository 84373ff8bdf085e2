// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/measurements.hpp"
#include "recordings/clouds/repeated_clouds.hpp"
#include "recordings/inspection/bag_info.hpp"
#include "recordings/inspection/static_interval.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/stream/repeated_samples.hpp"

namespace aims {

/// Layout of the first clouds of a topic, and whether later ones repeat.
class CloudInspection {
 public:
  explicit CloudInspection(std::string topic);
  /// `stamp`: of the header, or the record time.
  void add(const MessageView& message, Time stamp);
  CloudInfo finish() const;

 private:
  void add_layout(const PointTable& table, const MessageView& message);

  CloudInfo info_;
  RepeatedClouds repeats_;
  std::uint64_t points_ = 0;
  std::uint64_t not_finite_ = 0;
};

/// Unit, orientation and noise of one IMU topic.
class ImuInspection {
 public:
  explicit ImuInspection(std::string topic);
  void add(const MessageView& message, Time stamp);
  ImuInfo finish();

 private:
  void decide_unit();
  void add_in_si(ImuSample sample);

  ImuInfo info_;
  bool unit_known_ = false;
  std::vector<ImuSample> first_;  ///< until the unit is known
  std::optional<RepeatFilter> repeats_;
  StaticIntervalFinder static_intervals_;
};

}  // namespace aims
