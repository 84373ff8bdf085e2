// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/time.hpp"

namespace aims {

/// Shoves against the trunk: horizontal, constant while they last, each from a side of its own.
/// The time from `start` to `end` is split evenly among them; when a shove begins within its part
/// is drawn.
struct PushConfig {
  int count = 0;          ///< shoves in all; 0: none
  double force = 40.0;    ///< of each [N]
  double duration = 0.1;  ///< of each [s]
  double start = 0.0;     ///< of the time in which they fall [s]
  double end = 5.0;       ///< of that time [s]
};
void describe(Fields& f, PushConfig& c);

/// Error when the shoves do not fit between start and end.
Result<void> validate(const PushConfig& config);

/// The shoves of one run.
class Pushes {
 public:
  /// `config` is valid. Random stream: "push".
  Pushes(const PushConfig& config, std::uint64_t run_seed);

  /// Force on the trunk at that time, in the world frame [N]; zero between shoves.
  Eigen::Vector3d force_at(Time now) const;

 private:
  struct Shove {
    Time start = 0;
    Time end = 0;
    Eigen::Vector3d force;  ///< world frame [N]
  };
  std::vector<Shove> shoves_;  ///< in order of time
};

}  // namespace aims
