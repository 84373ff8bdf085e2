// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "core/measurements.hpp"

namespace aims {

/// Pending deliveries in order of arrival; equal arrivals go by kind of sensor (IMU, leg
/// odometry, LiDAR), then by the order in which they were sent.
class Arrivals {
 public:
  void add(Delivery delivery);

  /// Moves the deliveries that have arrived by `now` to the end of `out`.
  void take(Time now, std::vector<Delivery>& out);

 private:
  using Order = std::tuple<Time, std::size_t, std::uint64_t>;
  std::map<Order, Delivery> pending_;
  std::uint64_t sent_ = 0;
};

}  // namespace aims
