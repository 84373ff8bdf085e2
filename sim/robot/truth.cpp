// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/truth.hpp"

namespace aims {

Trajectory body_trajectory(const Truth& truth) {
  Trajectory trajectory;
  trajectory.reserve(truth.samples.size());
  for (const TruthSample& sample : truth.samples) {
    trajectory.push_back({sample.stamp, sample.T_world_body});
  }
  return trajectory;
}

}  // namespace aims
