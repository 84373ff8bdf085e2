// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "core/measurements.hpp"
#include "core/random.hpp"
#include "sim/sensors/leg_odometry_config.hpp"

namespace aims {

/// Force sensors in the feet and the detection of contact: a late, low-passed load with offset,
/// scale error and noise crosses one threshold upwards and another downwards.
class ContactSensor {
 public:
  /// Random streams: "leg.contact" for the noise, "leg.load" for the errors of each sensor.
  ContactSensor(const LegOdometryConfig& config, Duration timestep, std::uint64_t run_seed);

  /// At rest under those loads, with contacts detected.
  void begin(const FootLoads& loads);

  /// Takes the true loads after a physics step; call once per step.
  void update(const FootLoads& loads);

  /// Contacts at the end of an interval of `interval` [s].
  std::array<bool, kLegCount> detect(double interval);

  /// The loads by which the last call of `detect` decided.
  const FootLoads& measured() const { return measured_; }

  /// What the sensor of that foot reads, without noise [N].
  double load(int leg) const;

 private:
  LegOdometryConfig config_;
  double gain_;        ///< of the low-pass, per physics step
  std::size_t delay_;  ///< physics steps
  RandomStream noise_;
  FootLoads offset_{};                     ///< [N]
  std::array<double, kLegCount> scale_{};  ///< measured over true load
  FootLoads filtered_{};                   ///< present output of the low-pass [N]
  std::deque<FootLoads> delayed_;          ///< that output, oldest first [N]
  FootLoads measured_{};                   ///< with noise [N]
  std::array<bool, kLegCount> loaded_{};
  std::array<double, kLegCount> loaded_time_{};  ///< since touchdown [s]
};

}  // namespace aims
