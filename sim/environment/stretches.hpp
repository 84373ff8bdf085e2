// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/error.hpp"
#include "sim/environment/people.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims {

/// The level stretches of a scene's corridors, clear of their ends, of bends, ramps and crossings;
/// of a corridor with bends the longest.
std::vector<Stretch> stretches_of(const SceneConfig& scene);

/// Error for lanes that run into the walls or over the robot, or a scene without a stretch.
Result<void> validate_people(const SceneConfig& scene);

}  // namespace aims
