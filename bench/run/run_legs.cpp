// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/run_legs.hpp"

#include <algorithm>
#include <iterator>
#include <variant>

namespace aims {

void LegPackets::count(std::span<const Delivery> deliveries) {
  for (const Delivery& delivery : deliveries) {
    const auto* sample = std::get_if<LegOdometrySample>(&delivery.measurement);
    if (sample != nullptr) stamps_.insert(stamps_.end(), sample->stamp);
  }
}

std::size_t LegPackets::between(Time begin, Time end) const {
  return static_cast<std::size_t>(
      std::distance(stamps_.upper_bound(begin), stamps_.upper_bound(end)));
}

std::vector<LegInterval> leg_intervals(const SimulationConfig& config, const LegPackets& packets,
                                       const Truth& truth, Time end) {
  const Duration offset = from_seconds(config.links.leg_odometry.clock_offset);
  const double sent = config.leg_odometry.rate * to_seconds(kLegInterval);
  std::vector<LegInterval> intervals;
  auto sample = truth.samples.begin();
  for (Time stamp = kLegInterval; stamp <= end; stamp += kLegInterval) {
    const auto came =
        static_cast<double>(packets.between(stamp - kLegInterval + offset, stamp + offset));
    LegInterval interval = {stamp, std::clamp(1.0 - came / sent, 0.0, 1.0), 0.0};
    int samples = 0;
    for (; sample != truth.samples.end() && sample->stamp <= stamp; ++sample, ++samples) {
      interval.slip += *std::ranges::max_element(sample->slip_speed);
    }
    if (samples > 0) interval.slip /= samples;
    intervals.push_back(interval);
  }
  return intervals;
}

CsvTable legs_table(std::span<const LegInterval> intervals) {
  CsvTable table({"stamp_s", "loss", "slip_mps"});
  for (const LegInterval& each : intervals) {
    table.add(to_seconds(each.stamp)).add(each.loss).add(each.slip).end_row();
  }
  return table;
}

}  // namespace aims
