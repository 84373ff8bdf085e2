// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "recordings/source/leg_fields.hpp"

namespace aims {

/// The newest sample of each part at an instant.
struct JoinedParts {
  Time time = 0;  ///< mean of the stamps of those that are new
  std::vector<const LegPartSample*> samples;
  std::vector<bool> silent;  ///< the part has sent none for several of its periods
};

/// Joins samples of parts that are published apart: the newest of each, when all have a new one. A
/// part that has not by half a period after it was due lacks one: then its last sample serves.
/// Samples that are published only on change have no period: each makes a set with the last ones of
/// the other parts.
class PartJoiner {
 public:
  explicit PartJoiner(std::size_t parts, bool on_change = false)
      : on_change_(on_change), parts_(parts) {}

  /// Samples of a part come in order of time; others are left out.
  void add(std::size_t part, LegPartSample sample);

  /// The next complete set, valid until the next call; nothing: more samples are needed.
  std::optional<JoinedParts> next();

 private:
  struct Part {
    std::deque<LegPartSample> waiting;
    std::optional<LegPartSample> last;
    bool is_new = false;  ///< `last` is in no set yet
    int missed = 0;       ///< sets in a row without a new sample
    Time added = 0;       ///< stamp of the last one
    std::array<Duration, 16> steps{};
    std::size_t count = 0;  ///< of steps
    Duration period = 0;    ///< their median; 0: not known
  };

  static bool is_silent(const Part& part, Time time);
  bool is_late(const Part& part, Time time) const;
  bool is_awaited(const Part& part, Time time) const;
  std::optional<std::size_t> earliest() const;
  void take(Part& part);
  bool is_whole(Time time) const;
  bool lacks(Time time) const;
  JoinedParts give();

  bool on_change_;
  std::vector<Part> parts_;
  Time newest_ = 0;            ///< stamp of all
  Time given_ = 0;             ///< time of the last set
  std::optional<Time> begun_;  ///< earliest new stamp of the next set
};

}  // namespace aims
