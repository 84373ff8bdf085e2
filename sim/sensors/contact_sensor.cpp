// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/contact_sensor.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Share of a step that an output with that time constant follows within a physics step.
double gain_of(double time_constant, Duration timestep) {
  return time_constant > 0.0 ? 1.0 - std::exp(-to_seconds(timestep) / time_constant) : 1.0;
}

std::size_t steps_of(double time, Duration timestep) {
  return static_cast<std::size_t>(std::lround(time / to_seconds(timestep)));
}

}  // namespace

ContactSensor::ContactSensor(const LegOdometryConfig& config, Duration timestep, RunSeeds seeds)
    : config_(config),
      rise_(gain_of(config.load_rise_time, timestep)),
      fall_(gain_of(config.load_fall_time, timestep)),
      hold_(steps_of(config.load_hold, timestep)),
      delay_(steps_of(config.load_latency, timestep)),
      noise_(seeds.run, "leg.contact") {
  RandomStream errors(seeds.robot, "leg.load");
  for (int leg = 0; leg < kLegCount; ++leg) {
    offset_[leg] = config.load_offset * errors.normal();
    scale_[leg] = 1.0 + config.load_scale_error * errors.normal();
  }
  RandomStream zero(seeds.robot, "leg.load_zero");
  for (double& each : zero_) each = config.load_zero * zero.uniform();
}

void ContactSensor::begin(const FootLoads& loads) {
  held_.assign(1, loads);
  response_ = loads;
  delayed_.assign(1, loads);
  for (int leg = 0; leg < kLegCount; ++leg) {
    loaded_[leg] = load(leg) > config_.contact_on;
    loaded_time_[leg] = config_.contact_debounce;
  }
}

void ContactSensor::update(const FootLoads& loads) {
  held_.push_back(loads);
  if (held_.size() > hold_ + 1) held_.pop_front();
  for (int leg = 0; leg < kLegCount; ++leg) {
    double largest = loads[leg];
    for (const FootLoads& each : held_) largest = std::max(largest, each[leg]);
    const double gain = largest > response_[leg] ? rise_ : fall_;
    response_[leg] = gain < 1.0 ? response_[leg] + gain * (largest - response_[leg]) : largest;
  }
  delayed_.push_back(response_);
  if (delayed_.size() > delay_ + 1) delayed_.pop_front();
}

double ContactSensor::load(int leg) const {
  return scale_[leg] * delayed_.front()[leg] + offset_[leg];
}

std::array<bool, kLegCount> ContactSensor::detect(double interval) {
  std::array<bool, kLegCount> contact{};
  for (int leg = 0; leg < kLegCount; ++leg) {
    const double noisy = load(leg) + config_.load_noise * noise_.normal();
    measured_[leg] = noisy + zero_[leg];
    loaded_[leg] = noisy > (loaded_[leg] ? config_.contact_off : config_.contact_on);
    loaded_time_[leg] = loaded_[leg] ? loaded_time_[leg] + interval : 0.0;
    contact[leg] = loaded_[leg] && loaded_time_[leg] > config_.contact_debounce;
  }
  return contact;
}

}  // namespace aims
