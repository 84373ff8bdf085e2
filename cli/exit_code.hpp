// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aims {

/// Exit codes of the `aims` command.
enum ExitCode : int {
  kOk = 0,
  kExpectationFailed = 1,  ///< an expectation or an estimator failed; jobs are missing
  kBadInput = 2,           ///< usage, configuration or files
  kInternal = 3,           ///< a defect of this program
  kInvalidRun = 4,         ///< a run is invalid (bench/scoring/validity.hpp), or an estimate
  kInterrupted = 130,      ///< Ctrl-C; results so far are written; likewise 129 and 143
};

}  // namespace aims
