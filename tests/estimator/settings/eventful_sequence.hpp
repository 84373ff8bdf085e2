// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/measurements.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims::testing {

/// A stream and the rig that it comes from.
struct RecordedStream {
  std::vector<Delivery> deliveries;  ///< in order of arrival
  SensorRig rig;
};

/// A ramp and a slope so gentle that it may count as level.
inline constexpr RampConfig kShortRamp{.start = 3.2, .length = 0.8, .grade = 0.06};
inline constexpr RampConfig kGentleSlope{.start = 2.0, .length = 12.0, .grade = 0.006};

/// A few metres with a stop in between, over a ramp, in which every kind of disturbance happens:
/// lost, late, early and impossible packets of each sensor, slip, lost contacts.
RecordedStream eventful_sequence(const RampConfig& ramp);

/// The same stream from its first second of motion on.
RecordedStream started_in_motion(const RecordedStream& stream);

}  // namespace aims::testing
