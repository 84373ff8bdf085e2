// SPDX-License-Identifier: BSD-3-Clause
#include "sim/links/link.hpp"

#include <string>
#include <utility>

namespace aims {
namespace {

std::string stream_name(std::string_view link, std::string_view fault) {
  return "link." + std::string(link) + "." + std::string(fault);
}

/// The measurement as a sensor reports it that stamps it late by `offset`.
void shift_stamps(Measurement& measurement, Duration offset) {
  if (auto* scan = std::get_if<LidarScanPtr>(&measurement)) {
    auto shifted = std::make_shared<LidarScan>(**scan);
    shifted->stamp += offset;
    shifted->end += offset;
    *scan = std::move(shifted);
  } else if (auto* imu = std::get_if<ImuSample>(&measurement)) {
    imu->stamp += offset;
  } else {
    std::get<LegOdometrySample>(measurement).stamp += offset;
  }
}

}  // namespace

void describe(Fields& f, OutageConfig& c) {
  f.number(
      "start", c.start,
      {.unit = "s", .range = at_least(0), .meaning = "Of the first outage, in the recording."});
  f.number("length", c.length,
           {.unit = "s", .range = at_least(0), .meaning = "Of each outage; 0: none."});
  f.number("period", c.period,
           {.unit = "s", .range = at_least(0), .meaning = "From start to start; 0: one alone."});
}

bool is_out(const OutageConfig& outage, Time sent) {
  const Duration since = sent - from_seconds(outage.start);
  if (outage.length <= 0.0 || since < 0) return false;
  const Duration within = outage.period > 0.0 ? since % from_seconds(outage.period) : since;
  return within < from_seconds(outage.length);
}

void describe(Fields& f, LinkConfig& c) {
  const Range probability = in_range(0.0, 1.0);
  f.number("loss", c.loss,
           {.unit = "-", .range = probability, .meaning = "Packets lost independently."});
  f.number("burst_fraction", c.burst_fraction,
           {.unit = "-",
            .range = in_range(0.0, 0.5),
            .meaning = "Share of packets lost in bursts.",
            .source = "Gilbert-Elliott, all lost in the bad state"});
  f.number("burst_length", c.burst_length,
           {.unit = "packets", .range = at_least(1), .meaning = "Mean length of a burst."});
  f.number("delay", c.delay, {.unit = "s", .range = at_least(0), .meaning = "Of every packet."});
  f.number("jitter", c.jitter,
           {.unit = "s", .range = at_least(0), .meaning = "Largest further delay, uniform."});
  f.number("reorder_probability", c.reorder_probability,
           {.unit = "-", .range = probability, .meaning = "Packets held back."});
  f.number("reorder_delay", c.reorder_delay,
           {.unit = "s", .range = at_least(0), .meaning = "For which a packet is held back."});
  f.number("duplicate_probability", c.duplicate_probability,
           {.unit = "-", .range = probability, .meaning = "Packets that arrive twice."});
  f.number("stamp_jitter", c.stamp_jitter,
           {.unit = "s",
            .range = in_range(0.0, 1.0),
            .meaning = "Largest error of a stamp, uniform, either way."});
  f.number("clock_offset", c.clock_offset,
           {.unit = "s", .range = in_range(-10.0, 10.0), .meaning = "Added to the stamps."});
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
      in_burst_(burst_.chance(config.burst_fraction)) {}

bool Link::lost() {
  const bool lost_in_burst = in_burst_;
  const double leave = 1.0 / config_.burst_length;
  // Balance of the two transitions at the wanted share of the bad state.
  const double enter = leave * config_.burst_fraction / (1.0 - config_.burst_fraction);
  in_burst_ = burst_.chance(in_burst_ ? 1.0 - leave : enter);
  return loss_.chance(config_.loss) || lost_in_burst;
}

Time Link::arrival(Time sent) {
  const double held = reorder_.chance(config_.reorder_probability) ? config_.reorder_delay : 0.0;
  return sent + from_seconds(config_.delay + jitter_.uniform(0.0, config_.jitter) + held);
}

void Link::send(Time sent, Measurement measurement, std::vector<Delivery>& out) {
  const bool dropped = lost() || is_out(config_.outage, sent);
  const Time first = arrival(sent);
  const bool twice = duplicate_.chance(config_.duplicate_probability);
  const Duration behind = twice ? from_seconds(duplicate_.uniform(0.0, config_.jitter)) : 0;
  if (dropped) return;
  const double error = stamp_.uniform(-config_.stamp_jitter, config_.stamp_jitter);
  const Duration offset = from_seconds(config_.clock_offset + error);
  if (offset != 0) shift_stamps(measurement, offset);
  out.push_back({first, measurement});
  if (twice) out.push_back({first + behind, std::move(measurement)});
}

}  // namespace aims
