// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "bench/run/run.hpp"

namespace aims {

/// Shows a run's progress on standard error: a bar on a terminal, plain lines elsewhere.
class ProgressDisplay {
 public:
  /// `done` is what happens to the seconds that it counts: "simulated", "read".
  ProgressDisplay(std::string label, bool quiet, std::string done = "simulated");

  /// Of several seeds, the one under way; none for what has no seed.
  void show(std::optional<std::uint64_t> seed, const Progress& progress);
  /// Ends the bar's line.
  void close();

 private:
  std::string label_;
  std::string done_;
  bool quiet_;
  bool terminal_;
  bool bar_open_ = false;
  std::optional<std::uint64_t> seed_shown_;
  int tenths_shown_ = 0;
};

}  // namespace aims
