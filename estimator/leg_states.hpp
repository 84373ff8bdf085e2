// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/directional_config.hpp"
#include "estimator/kalman_update.hpp"

namespace aims {

/// The belief with the states of the legs (scale and bias) open, as far as they are switched on.
Belief open_leg_states(Belief belief, const LegStatesConfig& config);

/// The belief after the states of the legs have walked for `dt` [s].
void walk_leg_states(Belief& belief, const LegStatesConfig& config, double dt);

}  // namespace aims
