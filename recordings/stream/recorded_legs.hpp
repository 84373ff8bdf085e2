// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/leg_geometry.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// The legs of the robot, as the scenario in a simulated recording states them; nothing where no
/// scenario does. Rewinds the recording.
std::optional<LegGeometry> recorded_legs(MessageSource& recording);

}  // namespace aims
