// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace aims {

/// Seeds of a run: of noise, scene and start, and of what belongs to the robot and stays over its
/// runs (dimensions, mounts, constant errors of its sensors).
struct RunSeeds {
  /// One seed for both.
  RunSeeds(std::uint64_t seed) : run(seed), robot(seed) {}  // NOLINT(google-explicit-constructor)
  RunSeeds(std::uint64_t run_seed, std::uint64_t robot_seed) : run(run_seed), robot(robot_seed) {}

  std::uint64_t run;
  std::uint64_t robot;
};

}  // namespace aims
