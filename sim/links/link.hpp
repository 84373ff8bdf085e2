// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"

namespace aims {

/// Periodic intervals in which every packet is lost.
struct OutageConfig {
  double start = 0.0;     ///< of the first, after the start of the recording [s]
  double duration = 0.0;  ///< of each [s]; 0: none
  double period = 0.0;    ///< from start to start [s]; 0: a single outage
};

void describe(Fields& fields, OutageConfig& config);

/// Whether a packet sent at `sent` falls into an outage.
bool is_out(const OutageConfig& outage, Time sent);

/// Faults of the link from a sensor to the estimator. The default has none.
struct LinkConfig {
  double loss = 0.0;                   ///< probability that a packet is lost independently [-]
  double burst_fraction = 0.0;         ///< fraction of packets lost in bursts [-]
  double burst_length = 10.0;          ///< mean length of a burst [packets]
  double delay = 0.0;                  ///< of every packet [s]
  double jitter = 0.0;                 ///< largest additional delay, uniform [s]
  double reorder_probability = 0.0;    ///< that a packet is held back [-]
  double reorder_delay = 0.03;         ///< for which a packet is held back [s]
  double duplicate_probability = 0.0;  ///< that a packet arrives twice [-]
  double stamp_jitter = 0.0;           ///< largest error of a stamp, uniform around zero [s]
  double clock_offset = 0.0;           ///< of the sensor's clock: added to the stamps [s]
  double clock_offset_sigma = 0.0;     ///< of a further offset, drawn per run [s]
  double clock_drift_sigma = 0.0;      ///< of the rate of that clock, drawn per run [ppm]
  OutageConfig outage = {};
};

void describe(Fields& fields, LinkConfig& config);

/// The link from one sensor to the estimator.
class Link {
 public:
  /// Random streams are named "link.<name>.*": each fault has its own, so that a change
  /// of one does not affect the others.
  Link(const LinkConfig& config, std::uint64_t run_seed, std::string_view name);

  /// Appends the deliveries of a measurement sent at `sent`: none, one or two. Arrival times of
  /// successive calls need not be in order.
  void send(Time sent, Measurement measurement, std::vector<Delivery>& out);

 private:
  bool lost();
  Time arrival(Time sent);
  /// What clock and jitter [s] add to a true time.
  Duration stamp_error(Time stamp, double jitter) const;

  LinkConfig config_;
  RandomStream loss_, burst_, jitter_, reorder_, duplicate_, stamp_;
  bool in_burst_ = false;
  double clock_offset_ = 0.0;  ///< drawn and configured [s]
  double clock_drift_ = 0.0;   ///< [s/s]
};

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
