// SPDX-License-Identifier: BSD-3-Clause
#include "sim/links/link.hpp"

#include <string>
#include <utility>

namespace aims {

namespace {

std::string stream_name(std::string_view link, std::string_view fault) {
  return "link." + std::string(link) + "." + std::string(fault);
}

/// Adds to each stamp of a measurement what `error` is at its time.
template <class Error>
void shift_stamps(Measurement& measurement, const Error& error, double drift) {
  if (auto* scan = std::get_if<LidarScanPtr>(&measurement)) {
    auto shifted = std::make_shared<LidarScan>(**scan);
    // All scans are equally long, whatever their stamps are rounded to: a recording has the stamps
    // and one period.
    const Duration duration = shifted->end - shifted->stamp;
    shifted->stamp += error(shifted->stamp);
    shifted->end = shifted->stamp + duration + from_seconds(drift * to_seconds(duration));
    *scan = std::move(shifted);
  } else if (auto* imu = std::get_if<ImuSample>(&measurement)) {
    imu->stamp += error(imu->stamp);
  } else {
    auto& legs = std::get<LegOdometrySample>(measurement);
    legs.stamp += error(legs.stamp);
  }
}

}  // namespace

void describe(Fields& f, OutageConfig& c) {
  f.number("start", c.start,
           {.unit = "s",
            .range = up_to(1e6),
            .meaning = "Start of the first outage, from the start of the recording."});
  f.number("duration", c.duration,
           {.unit = "s", .range = up_to(1e6), .meaning = "Duration of an outage; 0 for none."});
  f.number("period", c.period,
           {.unit = "s",
            .range = up_to(1e6),
            .meaning = "Time from the start of one outage to the next; 0 for a single outage."});
}

bool is_out(const OutageConfig& outage, Time sent) {
  const Duration since = sent - from_seconds(outage.start);
  if (outage.duration <= 0.0 || since < 0) return false;
  const Duration period = from_seconds(outage.period);  // of less than half a nanosecond: zero
  const Duration within = period > 0 ? since % period : since;
  return within < from_seconds(outage.duration);
}

void describe(Fields& f, LinkConfig& c) {
  const Range probability = in_range(0.0, 1.0);
  f.number("loss", c.loss,
           {.unit = "-",
            .range = probability,
            .meaning = "Probability that a packet is lost independently of the others."});
  f.number("burst_fraction", c.burst_fraction,
           {.unit = "-",
            .range = in_range(0.0, 0.5),
            .meaning = "Fraction of the packets lost in bursts.",
            .source = "Gilbert-Elliott model; every packet is lost in the bad state"});
  f.number("burst_length", c.burst_length,
           {.unit = "packets",
            .range = in_range(1.0, 1e6),
            .meaning = "Mean length of a burst of lost packets."});
  f.number("delay", c.delay,
           {.unit = "s", .range = up_to(60.0), .meaning = "Constant delay of every packet."});
  f.number("jitter", c.jitter,
           {.unit = "s",
            .range = up_to(60.0),
            .meaning = "Largest additional random delay, uniformly distributed."});
  f.number("reorder_probability", c.reorder_probability,
           {.unit = "-",
            .range = probability,
            .meaning = "Probability that a packet is held back, which reorders packets."});
  f.number("reorder_delay", c.reorder_delay,
           {.unit = "s", .range = up_to(60.0), .meaning = "Time for which a packet is held back."});
  f.number(
      "duplicate_probability", c.duplicate_probability,
      {.unit = "-", .range = probability, .meaning = "Probability that a packet arrives twice."});
  f.number("stamp_jitter", c.stamp_jitter,
           {.unit = "s",
            .range = in_range(0.0, 1.0),
            .meaning = "Largest random error of a stamp, uniformly distributed around zero."});
  f.number("clock_offset", c.clock_offset,
           {.unit = "s",
            .range = in_range(-10.0, 10.0),
            .meaning = "Offset of the sensor's clock, added to its stamps."});
  f.number("clock_offset_sigma", c.clock_offset_sigma,
           {.unit = "s",
            .range = in_range(0.0, 1.0),
            .meaning = "Standard deviation of a further clock offset, constant in a run."});
  f.number("clock_drift_sigma", c.clock_drift_sigma,
           {.unit = "ppm",
            .range = in_range(0.0, 1000.0),
            .meaning = "Standard deviation of the clock's rate error, constant in a run."});
  f.group("outage", c.outage);
}

Link::Link(const LinkConfig& config, std::uint64_t run_seed, std::string_view name)
    : config_(config),
      loss_(run_seed, stream_name(name, "loss")),
      burst_(run_seed, stream_name(name, "burst")),
      jitter_(run_seed, stream_name(name, "jitter")),
      reorder_(run_seed, stream_name(name, "reorder")),
      duplicate_(run_seed, stream_name(name, "duplicate")),
      stamp_(run_seed, stream_name(name, "stamp")),
      in_burst_(burst_.chance(config.burst_fraction)) {
  RandomStream clock(run_seed, stream_name(name, "clock"));
  clock_offset_ = config.clock_offset + config.clock_offset_sigma * clock.normal();
  clock_drift_ = 1e-6 * config.clock_drift_sigma * clock.normal();
}

bool Link::lost() {
  const bool lost_in_burst = in_burst_;
  const double leave = 1.0 / config_.burst_length;
  // Stationary distribution with the configured fraction in the bad state.
  const double enter = leave * config_.burst_fraction / (1.0 - config_.burst_fraction);
  in_burst_ = burst_.chance(in_burst_ ? 1.0 - leave : enter);
  return loss_.chance(config_.loss) || lost_in_burst;
}

Time Link::arrival(Time sent) {
  const double held = reorder_.chance(config_.reorder_probability) ? config_.reorder_delay : 0.0;
  return sent + from_seconds(config_.delay + jitter_.uniform(0.0, config_.jitter) + held);
}

Duration Link::stamp_error(Time stamp, double jitter) const {
  return from_seconds(clock_offset_ + clock_drift_ * to_seconds(stamp) + jitter);
}

void Link::send(Time sent, Measurement measurement, std::vector<Delivery>& out) {
  const bool dropped = lost() || is_out(config_.outage, sent);
  const Time first = arrival(sent);
  const bool twice = duplicate_.chance(config_.duplicate_probability);
  const Duration behind = twice ? from_seconds(duplicate_.uniform(0.0, config_.jitter)) : 0;
  if (dropped) return;
  const double jitter = stamp_.uniform(-config_.stamp_jitter, config_.stamp_jitter);
  if (clock_offset_ != 0.0 || clock_drift_ != 0.0 || jitter != 0.0) {
    shift_stamps(
        measurement, [&](Time stamp) { return stamp_error(stamp, jitter); }, clock_drift_);
  }
  out.push_back({first, measurement});
  if (twice) out.push_back({first + behind, std::move(measurement)});
}

void Arrivals::add(Delivery delivery) {
  static_assert(std::is_same_v<std::variant_alternative_t<0, Measurement>, ImuSample>);
  const Order order{delivery.arrival, delivery.measurement.index(), sent_++};
  pending_.emplace(order, std::move(delivery));
}

void Arrivals::take(Time now, std::vector<Delivery>& out) {
  while (!pending_.empty() && pending_.begin()->second.arrival <= now) {
    out.push_back(std::move(pending_.begin()->second));
    pending_.erase(pending_.begin());
  }
}

}  // namespace aims
