// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "harness/run.hpp"

namespace aims {

/// Shows a run's progress on standard error: a bar on a terminal, plain lines elsewhere.
class ProgressDisplay {
 public:
  ProgressDisplay(std::string label, bool quiet);

  void show(std::uint64_t seed, const Progress& progress);
  /// Ends the bar's line.
  void close();

 private:
  std::string label_;
  bool quiet_;
  bool terminal_;
  bool bar_open_ = false;
  std::uint64_t seed_shown_ = 0;
  int tenths_shown_ = 0;
};

}  // namespace aims
