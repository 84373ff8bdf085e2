// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "bench/jobs/job_runner.hpp"
#include "core/stopwatch.hpp"

namespace aims {

/// The progress of jobs that are run batch after batch, as of one work: it never falls, and time
/// counts from the first batch on.
class BatchProgress {
 public:
  /// `expected` jobs in all batches; more are possible, and fewer.
  explicit BatchProgress(std::size_t expected) : expected_(expected) {}

  /// `batch`, the progress of a batch of `jobs` jobs that is under way, in the whole.
  JobProgress overall(std::size_t jobs, const JobProgress& batch);

  /// The batch has ended so.
  void end(std::size_t jobs, const JobRun& run);

 private:
  std::size_t expected_;
  std::size_t before_ = 0;  ///< jobs of the batches that ended, those found finished included
  JobRun ended_;            ///< their sums
  double fraction_ = 0.0;
  /// Simulations and evaluations, of the batches that ended and of the last look at this one.
  std::array<KindOfWork, 2> work_before_ = {};
  std::array<KindOfWork, 2> last_ = {};
  Stopwatch stopwatch_;
};

}  // namespace aims
