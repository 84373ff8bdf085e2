// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/measurements.hpp"

namespace aims {

/// Changes one delivery of a stream: appends what arrives in its place, none or several.
using FaultTransform = std::function<void(const Delivery&, std::vector<Delivery>&)>;

/// Time span of a fault in a sequence.
struct FaultWindow {
  Time begin = 0;
  Time end = 0;  ///< of faults that pass; permanent ones go on

  bool contains(Time time) const { return begin <= time && time < end; }
};

/// A named fault of a measurement stream.
struct StreamFault {
  std::string name;     ///< e.g. "imu.dead_10s"
  std::string meaning;  ///< one phrase
  bool always = false;  ///< from the first delivery on, e.g. a wrong extrinsic
  std::function<FaultTransform(const FaultWindow& window, std::uint64_t seed)> make;
};

/// Every fault: none, loss and delay at three levels, sensor death with and without return, clock
/// jumps, stamps, order, values of each field, scans and calibration.
std::vector<StreamFault> stream_faults();

}  // namespace aims
