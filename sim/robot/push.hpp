// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/time.hpp"

namespace aims {

/// Horizontal pushes on the trunk with constant force and random direction. The interval from
/// `start` to `end` is divided equally among them; each begins at a random time in its own part.
struct PushConfig {
  int count = 0;          ///< number of pushes; 0: none
  double force = 40.0;    ///< of a push [N]
  double duration = 0.1;  ///< of a push [s]
  double start = 0.0;     ///< of the interval with pushes [s]
  double end = 5.0;       ///< of the interval with pushes [s]
};
void describe(Fields& f, PushConfig& c);

/// Error when the pushes do not fit between start and end.
Result<void> validate(const PushConfig& config);

/// The pushes of one run.
class Pushes {
 public:
  /// `config` is valid. Random stream: "push".
  Pushes(const PushConfig& config, std::uint64_t run_seed);

  /// Force on the trunk at that time, in the world frame [N]; zero between pushes.
  Eigen::Vector3d force_at(Time now) const;

 private:
  struct Push {
    Time start = 0;
    Time end = 0;
    Eigen::Vector3d force;  ///< world frame [N]
  };
  std::vector<Push> pushes_;  ///< in order of time
};

}  // namespace aims
