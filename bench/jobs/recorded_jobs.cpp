// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/recorded_jobs.hpp"

#include <algorithm>

#include "bench/jobs/process_pool.hpp"
#include "core/stopwatch.hpp"

namespace aims {
namespace {

constexpr double kPatience = 0.2;  ///< between looks at the observer [s]

/// Stores what the work came to; the reply is an error text, or empty.
std::string do_job(const RecordedJob& each, const JobStore& store, std::atomic<double>& part) {
  const Stopwatch stopwatch;
  JobResult result = each.work(part);
  result.wall_s = stopwatch.seconds();
  const auto stored = store.put(each.job, result);
  return stored ? "" : stored.error().message;
}

/// A process that ended by itself says nothing, or why nothing could be stored.
Result<void> take(const EndedProcess& ended, const RecordedJob& each, const JobStore& store) {
  if (ended.end == ProcessEnd::kReturned) {
    return ended.text.empty() ? Result<void>() : failure(ended.text);
  }
  const bool late = ended.end == ProcessEnd::kTimedOut;
  JobResult result;
  result.outcome = late ? JobOutcome::kTimedOut : JobOutcome::kCrashed;
  result.message = late ? "stopped after its time" : "crashed: " + ended.text;
  return store.put(each.job, result);
}

/// The jobs without a result, and those to be done again.
std::vector<const RecordedJob*> missing_jobs(const std::vector<RecordedJob>& jobs,
                                             const JobStore& store, const JobOptions& options) {
  std::vector<const RecordedJob*> missing;
  for (const RecordedJob& each : jobs) {
    const auto known = store.find(each.job.id);
    const bool failed = known && known->outcome != JobOutcome::kDone;
    if (!known || options.redo || (options.retry && failed)) missing.push_back(&each);
  }
  return missing;
}

JobProgress progress_of(const JobRun& run, std::size_t total, double under_way,
                        const Stopwatch& stopwatch) {
  JobProgress progress;
  progress.done = run.done;
  progress.failed = run.failed;
  progress.total = total;
  progress.fraction = (static_cast<double>(run.done) + under_way) /
                      static_cast<double>(std::max<std::size_t>(1, total));
  progress.elapsed_s = stopwatch.seconds();
  return progress;
}

}  // namespace

Result<JobRun> run_recorded_jobs(const std::vector<RecordedJob>& jobs, const JobOptions& options,
                                 const JobObserver& observer) {
  const auto claim = claim_store(options.out);
  if (!claim) return tl::unexpected(claim.error());
  const JobStore store(options.out);
  std::vector<Job> listed;
  for (const RecordedJob& each : jobs) listed.push_back(each.job);
  if (auto entered = store.enter(listed, "", false); !entered) {
    return tl::unexpected(entered.error());
  }
  JobRun run;
  const auto missing = missing_jobs(jobs, store, options);
  run.reused = jobs.size() - missing.size();
  const Stopwatch stopwatch;
  ProcessPool pool(options.jobs);
  std::size_t next = 0;
  while (run.complete && (next < missing.size() || !pool.is_idle())) {
    for (; next < missing.size() && pool.has_room(); ++next) {
      const RecordedJob& each = *missing[next];
      const auto work = [&each, &store](std::atomic<double>& part) {
        return do_job(each, store, part);
      };
      if (auto started = pool.start(next, options.timeout_s, work); !started) {
        return tl::unexpected(started.error());
      }
    }
    for (const EndedProcess& ended : pool.wait(kPatience)) {
      const RecordedJob& each = *missing[ended.key];
      if (auto taken = take(ended, each, store); !taken) return tl::unexpected(taken.error());
      ++run.done;
      const auto result = store.find(each.job.id);
      run.failed += result && result->outcome == JobOutcome::kDone ? 0 : 1;
    }
    run.complete = observer(progress_of(run, missing.size(), pool.part_under_way(), stopwatch));
  }
  return run;
}

}  // namespace aims
