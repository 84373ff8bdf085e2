// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "core/measurements.hpp"
#include "core/random.hpp"
#include "sim/run_seeds.hpp"
#include "sim/sensors/leg_odometry_config.hpp"

namespace aims {

/// Force sensors in the feet and the detection of contact. A sensor reads the largest load of the
/// last `load_hold`, follows it with one time constant upwards and another downwards, and is late.
/// With offset, scale error and noise that load crosses one threshold upwards and another
/// downwards.
class ContactSensor {
 public:
  /// Random streams: "leg.contact" for the noise; of the robot, "leg.load" and "leg.load_zero" for
  /// the errors of each sensor.
  ContactSensor(const LegOdometryConfig& config, Duration timestep, RunSeeds seeds);

  /// At rest under those loads, with contacts detected.
  void begin(const FootLoads& loads);

  /// Takes the true loads after a physics step; call once per step.
  void update(const FootLoads& loads);

  /// Contacts at the end of an interval of `interval` [s].
  std::array<bool, kLegCount> detect(double interval);

  /// What the sensors read in the last call of `detect`: the loads by which it decided, plus what
  /// each sensor reads without load [N].
  const FootLoads& measured() const { return measured_; }

  /// The load of that foot by which contact is detected, without noise [N].
  double load(int leg) const;

 private:
  LegOdometryConfig config_;
  double rise_;        ///< of the response, per physics step
  double fall_;        ///< of the response, per physics step
  std::size_t hold_;   ///< physics steps
  std::size_t delay_;  ///< physics steps
  RandomStream noise_;
  FootLoads zero_{};                       ///< reading without load [N]
  FootLoads offset_{};                     ///< [N]
  std::array<double, kLegCount> scale_{};  ///< measured over true load
  std::deque<FootLoads> held_;             ///< true loads of the last hold, oldest first [N]
  FootLoads response_{};                   ///< present output [N]
  std::deque<FootLoads> delayed_;          ///< that output, oldest first [N]
  FootLoads measured_{};                   ///< with noise [N]
  std::array<bool, kLegCount> loaded_{};
  std::array<double, kLegCount> loaded_time_{};  ///< since touchdown [s]
};

}  // namespace aims
