// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/mounts.hpp"

#include <numbers>

#include "core/random.hpp"

namespace aims {
namespace {

/// The nominal mount followed by a small random turn and shift in its own axes.
Pose displaced(const Pose& nominal, const CalibrationErrorConfig& config, RandomStream random) {
  const double turn = config.rotation_sigma_deg * std::numbers::pi / 180.0;
  Pose error;
  error.rotation = so3_exp(turn * random.normal3());
  error.translation = config.translation_sigma * random.normal3();
  return nominal * error;
}

}  // namespace

void describe(Fields& f, CalibrationErrorConfig& c) {
  f.number("rotation_sigma_deg", c.rotation_sigma_deg,
           {.unit = "deg",
            .range = in_range(0.0, 10.0),
            .meaning = "Standard deviation per axis of the error of a mount's known rotation."});
  f.number("translation_sigma", c.translation_sigma,
           {.unit = "m",
            .range = in_range(0.0, 0.1),
            .meaning = "Standard deviation per axis of the error of a mount's known position."});
}

Mounts true_mounts(const Mounts& nominal, const CalibrationErrorConfig& config,
                   std::uint64_t run_seed) {
  if (config.rotation_sigma_deg <= 0.0 && config.translation_sigma <= 0.0) return nominal;
  return {displaced(nominal.T_base_body, config, RandomStream(run_seed, "calibration.imu")),
          displaced(nominal.T_body_lidar, config, RandomStream(run_seed, "calibration.lidar"))};
}

}  // namespace aims
