// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "bench/jobs/job_runner.hpp"
#include "core/error.hpp"

namespace aims {

/// A job that reads a recording in place of a simulated sequence.
struct RecordedJob {
  Job job;                                                   ///< under its id
  std::function<JobResult(std::atomic<double>& part)> work;  ///< in a process of its own
};

/// Does those of the jobs that `options.out` lacks, each in a process of its own, as `run_jobs`
/// does those on simulated sequences.
Result<JobRun> run_recorded_jobs(const std::vector<RecordedJob>& jobs, const JobOptions& options,
                                 const JobObserver& observer);

}  // namespace aims
