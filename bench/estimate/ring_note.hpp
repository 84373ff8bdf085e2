// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "core/lidar_rings.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims {

/// What an estimator with these requirements lacks of a LiDAR with these rings: it needs rings and
/// there are none, or its range image has other rows. `label` names the estimator, `source` what
/// lacks them ("recording"). One sentence; empty when nothing is lacking.
std::string ring_note(std::string_view label, const Requirements& needs, const LidarRings& rings,
                      std::string_view source);

}  // namespace aims
