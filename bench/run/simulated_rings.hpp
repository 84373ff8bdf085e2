// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench/estimate/ring_note.hpp"
#include "bench/scenario/scenario.hpp"

namespace aims {

/// The rings of a simulated LiDAR.
LidarRings rings_of(const LidarConfig& config);

/// A sentence for each estimator of the scenario that its LiDAR does not fit.
std::vector<std::string> ring_notes(const Scenario& scenario);

}  // namespace aims
