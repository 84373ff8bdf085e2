// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/python/python_process.hpp"

namespace aims {

/// Measurements on their way to a Python process, sorted by kind, and their order.
class PythonBatch {
 public:
  void add(Time arrival, const ImuSample& sample);
  void add(Time arrival, const LegOdometrySample& sample);
  /// A scan whose points lie in `part` of the memory shared with the process.
  void add(Time arrival, const LidarScan& scan, const SharedMemory::Part& part);

  std::size_t size() const { return order_.size(); }

  /// The message of what was added; then empty.
  PipeMessage take();

 private:
  enum class Event : std::uint8_t { kImu = 1, kLegs = 2, kScan = 3 };

  std::vector<Event> order_;
  PipeMessage imu_;
  PipeMessage legs_;
  PipeMessage scans_;
};

}  // namespace aims
