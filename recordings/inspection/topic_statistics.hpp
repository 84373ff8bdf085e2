// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/time.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// Computes the timing of `TopicInfo`, message by message. Memory is bounded: the first million
/// messages count.
class TopicStatistics {
 public:
  /// `stamp` is empty for a message without a header.
  void add(Time record_time, std::optional<Time> stamp);

  /// Fills in the timing of `info`.
  void finish(TopicInfo& info);

 private:
  struct Entry {
    Time record = 0;
    Time stamp = 0;  ///< of the header, or the record time
  };
  /// Whether record times step back while the stamps run on; then fills in by how much and sorts by
  /// stamp.
  bool recorder_was_set_back(TopicInfo& info);
  void finish_spacings(TopicInfo& info) const;
  void finish_offsets(TopicInfo& info) const;

  std::uint64_t messages_ = 0;
  bool stamped_ = false;
  std::vector<Entry> entries_;
};

}  // namespace aims
