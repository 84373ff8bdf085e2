// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/jobs/job_runner.hpp"
#include "core/error.hpp"

namespace aims {

/// Part `index` of `count` (from 1) of a plan's jobs.
struct Shard {
  int index = 1;
  int count = 1;
};

/// The shard of "2/8".
Result<Shard> parse_shard(std::string_view text);

/// The shard's jobs: neighbours, as the plan orders them, so that a shard needs few sequences. The
/// shards differ by one job at most, and together are all jobs.
std::span<const Job> part_of(std::span<const Job> jobs, const Shard& shard);

struct SweepOptions {
  std::filesystem::path out;    ///< folder that is filled or continued
  std::filesystem::path cache;  ///< of simulated sequences; empty: `SequenceCache::default_folder()`
  std::uintmax_t cache_limit = kCacheLimit;  ///< of those sequences [bytes]; 0: any
  int jobs = 1;                              ///< processes at a time
  Shard shard;
  double timeout_s = 0.0;   ///< wall time that a job is given [s]; 0: any
  bool retry = false;       ///< do what failed before again
  bool renew = false;       ///< take the plan although the folder is of another plan or code
  bool simulate_only = false;  ///< simulate what is missing and evaluate nothing
};

/// Does the shard's jobs that `out` has no result of, each into `out/jobs/ID.json`. The folder
/// also gets plan.yaml, the plan (YAML), and jobs.csv, all jobs by their ids. Error when the
/// folder is something else, belongs to another plan or to another version of code or scenarios, or
/// when another sweep works on it; shards of one plan may work on it together.
Result<JobRun> run_sweep(const std::string& plan, std::span<const Job> jobs,
                          const SweepOptions& options, const JobObserver& observer);

}  // namespace aims
