// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"

namespace aims {

/// Stretches of time in which nothing comes through.
struct OutageConfig {
  double start = 0.0;   ///< of the first, after the start of the recording [s]
  double length = 0.0;  ///< of each [s]; 0: none
  double period = 0.0;  ///< from start to start [s]; 0: one outage alone
};

void describe(Fields& fields, OutageConfig& config);

/// Whether a packet sent at `sent` falls into an outage.
bool is_out(const OutageConfig& outage, Time sent);

/// What happens to a sensor's packets on their way. The default changes nothing.
struct LinkConfig {
  double loss = 0.0;                   ///< probability that a packet is lost on its own [-]
  double burst_fraction = 0.0;         ///< share of packets lost in bursts [-]
  double burst_length = 10.0;          ///< mean length of a burst [packets]
  double delay = 0.0;                  ///< of every packet [s]
  double jitter = 0.0;                 ///< largest further delay, uniformly distributed [s]
  double reorder_probability = 0.0;    ///< that a packet is held back [-]
  double reorder_delay = 0.03;         ///< for which a packet is held back [s]
  double duplicate_probability = 0.0;  ///< that a packet arrives twice [-]
  double stamp_jitter = 0.0;           ///< largest error of a stamp, uniform, either way [s]
  double clock_offset = 0.0;           ///< of the sensor's clock: added to the stamps [s]
  OutageConfig outage = {};
};

void describe(Fields& fields, LinkConfig& config);

/// The way of one sensor's measurements to the estimator.
class Link {
 public:
  /// Random streams are named "link.<name>.*": each fault has its own, so that changing one
  /// leaves the others as they were.
  Link(const LinkConfig& config, std::uint64_t run_seed, std::string_view name);

  /// Appends what becomes of a measurement sent at `sent`: no, one or two deliveries with their
  /// arrivals. Arrivals of successive calls need not be in order.
  void send(Time sent, Measurement measurement, std::vector<Delivery>& out);

 private:
  bool lost();
  Time arrival(Time sent);

  LinkConfig config_;
  RandomStream loss_, burst_, jitter_, reorder_, duplicate_, stamp_;
  bool in_burst_ = false;
};

}  // namespace aims
