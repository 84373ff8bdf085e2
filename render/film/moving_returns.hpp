// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// For each return of a scan whether it came from a person, by the true poses of robot
/// (`truth`, T_world_body) and people at its firing time. Empty in a scene without people. For
/// pictures: no estimator has this.
std::vector<bool> moving_returns(const LidarScan& scan, const Scene& scene, const Trajectory& truth,
                                 const Pose& T_body_lidar);

}  // namespace aims
