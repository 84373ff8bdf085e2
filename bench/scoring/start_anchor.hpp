// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "bench/metrics/scores.hpp"
#include "core/lie.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// T_world_odom that lays the estimate's start onto the truth, as the scores do.
Pose start_anchor(const Trajectory& estimate, const Trajectory& truth, const ScoreConfig& scoring);

/// The valid poses of the estimate, laid onto the truth by `start_anchor`.
Trajectory anchored(const Trajectory& estimate, const Trajectory& truth,
                    const ScoreConfig& scoring);

/// Such a trajectory, turned about its first pose by the heading that fits it to the truth best, as
/// the plan on the page of a run; only what comes before `failed`, if it did, decides the heading.
Trajectory heading_fitted(Trajectory anchored, const Trajectory& truth, const ScoreConfig& scoring,
                          std::optional<Time> failed);

/// What a picture says of that alignment.
inline constexpr const char* kHeadingFitted = "estimates aligned by start and fitted heading";

}  // namespace aims
