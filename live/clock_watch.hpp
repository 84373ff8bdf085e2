// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// Notices clocks that were set while topics are read, e.g. by a driver that restarts. A clock has
/// jumped when the stamps of a topic differ from their arrivals by a second more or less than
/// before, and all stamps of a second agree: late messages do not.
class ClockWatch {
 public:
  /// A message of a sensor; `stamp`: of its header, none for one without.
  void add(const std::string& topic, std::optional<Time> stamp, Time arrival);

  /// Why no estimate can go on: all clocks have jumped, or the times of arrival went back. Empty:
  /// it can.
  const std::string& broken() const { return broken_; }

  /// "the clock of /points jumped by -3600.0 s", of clocks that differ from the others now; "the
  /// stamps of /points stay at 0.1 s", where messages come and their stamps do not change.
  std::vector<std::string> differing() const;

 private:
  struct Clock {
    Duration offset = 0;            ///< of the last stamp over its arrival, without a jump
    Time seen = 0;                  ///< last arrival
    Duration read = 0;              ///< time read until then
    std::optional<Time> jumped_at;  ///< arrival of the first message of the jump
    Duration jumped_to = 0;         ///< offset since then
    Time stamp = 0;                 ///< the last one
    Time stays_since = 0;           ///< arrival of the first message with it
  };
  bool jumped(const Clock& clock, Duration lasting) const;
  bool present(const Clock& clock) const;
  void judge();

  std::map<std::string, Clock> clocks_;
  std::optional<Time> newest_;  ///< arrival
  Duration read_ = 0;           ///< time in which messages came
  std::string broken_;
};

}  // namespace aims
