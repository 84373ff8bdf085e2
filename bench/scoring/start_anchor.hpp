// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/metrics/scores.hpp"
#include "core/lie.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// T_world_odom that lays the estimate's start onto the truth, as the scores do.
Pose start_anchor(const Trajectory& estimate, const Trajectory& truth, const ScoreConfig& scoring);

/// The valid poses of the estimate, laid onto the truth by `start_anchor`.
Trajectory anchored(const Trajectory& estimate, const Trajectory& truth,
                    const ScoreConfig& scoring);

}  // namespace aims
