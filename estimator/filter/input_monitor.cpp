// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/input_monitor.hpp"

#include <algorithm>

namespace aims {
namespace {

/// Measurements over which the fraction of rejected ones is averaged.
constexpr double kFractionSamples = 20.0;

}  // namespace

InputMonitor::Input& InputMonitor::note(Sensor sensor, Time arrival, bool rejected) {
  if (!first_) first_ = arrival;
  Input& input = inputs_[static_cast<std::size_t>(sensor)];
  input.rejected += ((rejected ? 1.0 : 0.0) - input.rejected) / kFractionSamples;
  return input;
}

void InputMonitor::accepted(Sensor sensor, Time arrival) {
  note(sensor, arrival, false).last = arrival;
}

void InputMonitor::rejected(Sensor sensor, Time arrival) { note(sensor, arrival, true); }

void InputMonitor::accepted_force(const Eigen::Vector3d& specific_force) {
  forces_ = std::min(forces_ + 1, kForceSamples);
  force_ += (specific_force - force_) / forces_;
}

double InputMonitor::silence(Sensor sensor, Time now) const {
  const Time since = of(sensor).last.value_or(first_.value_or(now));
  return std::max(0.0, to_seconds(now - since));
}

std::optional<double> InputMonitor::mean_force() const {
  if (forces_ < kForceSamples) return std::nullopt;
  return force_.norm();
}

}  // namespace aims
