// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "recordings/clouds/point_table.hpp"

namespace aims {

/// Recognizes a LiDAR or driver that hangs: the same points come again under new stamps, which the
/// noise of no LiDAR allows.
class RepeatedClouds {
 public:
  /// Adds the next cloud; `table` is valid.
  void add(const PointTable& table);

  /// Whether more clouds are repetitions than ever happen by a hitch of the network.
  bool found() const;
  int repeated() const { return repeated_; }
  int clouds() const { return clouds_; }
  /// Stamp of the first repetition; 0: none.
  Time first() const { return first_; }

 private:
  std::vector<double> last_;  ///< coordinates of some points of the last cloud
  std::size_t size_ = 0;      ///< its number of points
  Time stamp_ = 0;
  int clouds_ = 0, repeated_ = 0;
  int run_ = 0, longest_run_ = 0;  ///< of repetitions one after the other
  Time first_ = 0;
};

/// The sentence on it.
std::string repeated_clouds_text(const std::string& topic, int repeated, int clouds);

}  // namespace aims
