// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/environment/scene_config.hpp"

namespace aims {

/// Error when the floor would need more grid points than can be made in a few seconds.
Result<void> validate(const BumpConfig& bumps, const Floor& floor);

/// Fills the floor's rectangle with smooth random heights in [0, bumps.height]; keeps it flat
/// when that is 0. Heights are correlated as exp(-d^2 / (2 correlation_length^2)).
void add_bumps(const BumpConfig& bumps, std::uint64_t seed, Floor& floor);

}  // namespace aims
