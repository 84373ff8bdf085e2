// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <span>
#include <vector>

#include "core/files/csv.hpp"
#include "core/measurements.hpp"
#include "sim/robot/truth.hpp"
#include "sim/simulation_config.hpp"

namespace aims {

/// Length of the intervals of legs.csv.
inline constexpr Duration kLegInterval = 100 * kMillisecond;

/// Lost packets of leg odometry in one interval of a run, and true slip of the feet.
struct LegInterval {
  Time stamp = 0;     ///< end of the interval
  double loss = 0.0;  ///< fraction of lost packets, in [0, 1]
  double slip = 0.0;  ///< true speed of the fastest standing foot over the ground, mean [m/s]
};

/// Counts the packets of leg odometry that reach the estimators, by their stamps.
class LegPackets {
 public:
  void count(std::span<const Delivery> deliveries);

  /// The packets with a stamp after `begin` and up to `end`; one that came twice counts once.
  std::size_t between(Time begin, Time end) const;

 private:
  std::set<Time> stamps_;
};

/// The complete intervals of a run that lasted until `end`, of packets sent at the configured rate.
/// Stamps are taken as they came: where they jitter, a packet may fall into the next interval.
std::vector<LegInterval> leg_intervals(const SimulationConfig& config, const LegPackets& packets,
                                       const Truth& truth, Time end);

/// One row per interval.
CsvTable legs_table(std::span<const LegInterval> intervals);

}  // namespace aims
