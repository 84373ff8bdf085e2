// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/truth.hpp"

namespace aims {

Trajectory body_trajectory(const Truth& truth) {
  Trajectory trajectory;
  trajectory.reserve(truth.samples.size());
  for (const TruthSample& sample : truth.samples) {
    trajectory.push_back({sample.stamp, sample.T_world_body});
    trajectory.back().pose.rotation.normalize();  // as readers of its files do
  }
  return trajectory;
}

}  // namespace aims
