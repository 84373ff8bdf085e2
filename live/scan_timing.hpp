// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <utility>

#include "core/measurements.hpp"
#include "core/time.hpp"

namespace aims {

/// From the arrival of scans to their odometry, without those that waited for the start; and how
/// often measurements arrive.
class ScanTiming {
 public:
  ScanTiming();

  void arrived(const Delivery& delivery, Time arrival);
  void published(Time stamp);

  /// Latency [ms], rounded down; of more than a second: a second. 0 before the first scan.
  std::size_t quantile(double part) const;
  std::size_t scans() const { return total_; }  ///< with a latency

  /// Scans and IMU samples per second, about the last second.
  std::pair<double, double> rates();

 private:
  Time first_;                                 ///< scans that arrived before waited for the start
  std::deque<std::pair<Time, Time>> waiting_;  ///< end and arrival of scans
  std::array<std::size_t, 1001> counts_{};     ///< by whole milliseconds
  std::size_t total_ = 0;
  Time rates_from_;
  std::pair<double, double> rates_ = {0.0, 0.0};
  std::size_t scans_ = 0;
  std::size_t samples_ = 0;
};

}  // namespace aims
