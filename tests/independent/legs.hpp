// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/measurements.hpp"
#include "tests/independent/motion.hpp"

namespace aims::independent {

struct LegOptions {
  double rate_hz = 200.0;
  double scale = 1.045;           ///< reported over true velocity
  double white_noise = 0.03;      ///< of a sample while walking [m/s]
  double step_noise = 0.02;       ///< constant over each half stride [m/s]
  double standing_noise = 0.002;  ///< [m/s]
  double turn_noise = 0.01;       ///< of a sample [rad/s]
  double heading_drift = 1.0e-3;  ///< deviation over seeds [rad/s]
  double single_loss = 0.02;      ///< probability that a packet is lost alone
  double burst_loss = 0.02;       ///< fraction of packets lost in bursts
  double burst_length = 10.0;     ///< mean, in packets
  std::uint64_t seed = 1;
};

/// Packets that arrive: pose in the odometry's own frame and twist of the base, no joints, no
/// contacts.
std::vector<LegOdometrySample> sample_legs(const Walk& walk, const Pose& T_body_base,
                                           const LegOptions& options);

}  // namespace aims::independent
