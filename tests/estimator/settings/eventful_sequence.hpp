// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/measurements.hpp"

namespace aims::testing {

/// A stream and the rig that it comes from.
struct RecordedStream {
  std::vector<Delivery> deliveries;  ///< in order of arrival
  SensorRig rig;
};

/// A few metres with a stop in between, over a ramp, in which every kind of disturbance happens:
/// lost, late, early and impossible packets of each sensor, slip, lost contacts. Each ring of the
/// LiDAR has `columns` returns.
RecordedStream eventful_sequence(int columns);

/// The same stream from its first second of motion on.
RecordedStream started_in_motion(const RecordedStream& stream);

}  // namespace aims::testing
