// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/contact_sensor.hpp"

#include <cmath>

namespace aims {

ContactSensor::ContactSensor(const LegOdometryConfig& config, Duration timestep,
                             std::uint64_t run_seed)
    : config_(config),
      gain_(config.load_time_constant > 0.0
                ? 1.0 - std::exp(-to_seconds(timestep) / config.load_time_constant)
                : 1.0),
      delay_(static_cast<std::size_t>(std::lround(config.load_latency / to_seconds(timestep)))),
      noise_(run_seed, "leg.contact") {
  RandomStream run(run_seed, "leg.load");
  for (int leg = 0; leg < kLegCount; ++leg) {
    offset_[leg] = config.load_offset * run.normal();
    scale_[leg] = 1.0 + config.load_scale_error * run.normal();
  }
}

void ContactSensor::begin(const FootLoads& loads) {
  filtered_ = loads;
  delayed_.assign(1, loads);
  for (int leg = 0; leg < kLegCount; ++leg) {
    loaded_[leg] = load(leg) > config_.contact_on;
    loaded_time_[leg] = config_.contact_debounce;
  }
}

void ContactSensor::update(const FootLoads& loads) {
  for (int leg = 0; leg < kLegCount; ++leg) {
    filtered_[leg] =
        gain_ < 1.0 ? filtered_[leg] + gain_ * (loads[leg] - filtered_[leg]) : loads[leg];
  }
  delayed_.push_back(filtered_);
  if (delayed_.size() > delay_ + 1) delayed_.pop_front();
}

double ContactSensor::load(int leg) const {
  return scale_[leg] * delayed_.front()[leg] + offset_[leg];
}

std::array<bool, kLegCount> ContactSensor::detect(double interval) {
  std::array<bool, kLegCount> contact{};
  for (int leg = 0; leg < kLegCount; ++leg) {
    measured_[leg] = load(leg) + config_.load_noise * noise_.normal();
    loaded_[leg] = measured_[leg] > (loaded_[leg] ? config_.contact_off : config_.contact_on);
    loaded_time_[leg] = loaded_[leg] ? loaded_time_[leg] + interval : 0.0;
    contact[leg] = loaded_[leg] && loaded_time_[leg] > config_.contact_debounce;
  }
  return contact;
}

}  // namespace aims
