// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/time.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// Computes the timing of `TopicInfo`, message by message. Memory is bounded: medians use the first
/// million messages.
class TopicStatistics {
 public:
  /// `stamp` is empty for a message without a header.
  void add(Time record_time, std::optional<Time> stamp);

  /// Fills in the timing of `info`.
  void finish(TopicInfo& info);

 private:
  std::uint64_t messages_ = 0;
  std::uint64_t repeated_ = 0;
  std::uint64_t backwards_ = 0;
  bool stamped_ = false;
  Time first_ = 0;
  Time last_ = 0;
  double largest_gap_s_ = 0.0;
  std::vector<float> spacings_s_;
  std::vector<float> offsets_s_;
};

}  // namespace aims
