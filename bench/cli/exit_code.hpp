// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aims {

/// What the `aims` command returns to its caller.
enum ExitCode : int {
  kOk = 0,
  kGateFailed = 1,     ///< a scenario's expectation does not hold; a unit of a sweep failed
  kBadInput = 2,       ///< usage, configuration or files
  kInternal = 3,       ///< a defect of this program
  kInterrupted = 130,  ///< Ctrl-C; what was recorded so far is written
};

}  // namespace aims
