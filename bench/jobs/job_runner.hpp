// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/jobs/job_store.hpp"
#include "bench/jobs/sequence_cache.hpp"
#include "bench/run/evaluate.hpp"
#include "core/error.hpp"

namespace aims {

/// What a cache of sequences may hold by default [bytes].
inline constexpr std::uintmax_t kCacheLimit = 20'000'000'000;

struct JobOptions {
  std::filesystem::path out;    ///< job store that is filled or continued
  std::filesystem::path cache;  ///< of sequences; empty: `SequenceCache::default_folder()`
  /// Of the cache's sequences [bytes]; 0: any. Those that jobs wait for stay.
  std::uintmax_t cache_limit = kCacheLimit;
  std::set<std::string> kept_sequences = {};  ///< ids that others wait for
  int jobs = 1;                ///< processes at a time; the results do not depend on it
  double timeout_s = 0.0;      ///< wall time that a job is given [s]; 0: any
  bool retry = false;          ///< do what failed before again
  bool redo = false;           ///< do everything again
  bool simulate_only = false;  ///< simulate what is missing and evaluate nothing
  JobOutputs outputs;          ///< that are kept besides scores
};

/// Work of one kind and the wall time of its processes.
struct KindOfWork {
  std::size_t total = 0;
  double done = 0.0;     ///< what is under way counts in part
  double seconds = 0.0;  ///< that this took
};

/// The time that is left on so many processes: what is left of each kind at its own rate. None as
/// long as too little is done of any kind that is left: simulating takes longer than estimating.
std::optional<double> time_left(const KindOfWork& simulation, const KindOfWork& evaluation,
                                int processes);

/// How far the jobs have come.
struct JobProgress {
  std::size_t done = 0;       ///< of this invocation, failures included
  std::size_t failed = 0;     ///< of them
  std::size_t total = 0;      ///< without those that were found finished
  bool at_most = false;       ///< the work may end before the total
  std::size_t sequences = 0;  ///< simulated
  double fraction = 0.0;      ///< of all work, what is under way included, in [0, 1]
  double elapsed_s = 0.0;
  KindOfWork simulation;         ///< sequences to be simulated
  KindOfWork evaluation;         ///< jobs
  int processes = 1;             ///< at a time
  std::optional<double> left_s;  ///< none before enough is done
};

/// Returning false ends the work with what is finished.
using JobObserver = std::function<bool(const JobProgress&)>;

/// What an invocation did.
struct JobRun {
  std::size_t done = 0;       ///< evaluated now, failures included
  std::size_t failed = 0;     ///< of them
  std::size_t reused = 0;     ///< found finished
  std::size_t invalid = 0;    ///< of both: on invalid runs (bench/scoring/validity.hpp)
  std::size_t sequences = 0;  ///< simulated now
  bool complete = true;       ///< false when the observer ended it early
  CachePruned pruned;         ///< from the cache, in all runs of the runner
};

/// Runs an estimator over a sequence; `evaluate`, but for tests.
using Evaluate =
    std::function<Result<EstimatorOutcome>(const Sequence& sequence, const Scenario& scenario,
                                           const std::string& estimator, const PartObserver&)>;

/// Does jobs, each in a process of its own, so that one that crashes or hangs is recorded as such
/// and stops nothing else. Each sequence is simulated once, also in a process of its own, and read
/// by all jobs on it; a job on a recording needs none. The calling process must not have other
/// threads that work meanwhile.
///
///   JobRunner runner({.out = out, .jobs = 2});
///   runner.run(jobs, observer);                       // those that are not there yet
///   const auto result = runner.store().find(jobs[0].id);
class JobRunner {
 public:
  explicit JobRunner(JobOptions options, Evaluate evaluate = aims::evaluate);

  /// Does those of the jobs that have no result with the outputs that are wanted. A job that fails
  /// is a result; an error is what keeps all jobs from being done, e.g. a full disk.
  Result<JobRun> run(std::span<const Job> jobs, const JobObserver& observer);

  const JobStore& store() const { return store_; }

  /// What went from the cache so far.
  const CachePruned& pruned() const { return pruned_; }

 private:
  friend class JobSchedule;
  struct OpenSequence {
    std::string id;
    std::unique_ptr<const Sequence> sequence;
    std::optional<FolderLock> in_use;
  };

  /// The result of a job that has not to be done again; none of others.
  std::optional<JobResult> finished(const Job& job);
  std::string sequence_id(const Job& job);
  /// The open sequence; opens it, and closes the one that was opened first when there are many.
  Result<const Sequence*> open(const std::string& id, const Scenario& scenario, std::uint64_t seed);
  /// Closes the sequences but those of these ids, and keeps the cache within its limit, but for
  /// them and those that processes read.
  void prune(std::set<std::string> kept);

  JobOptions options_;
  Evaluate evaluate_;
  JobStore store_;
  SequenceCache cache_;
  std::map<std::pair<std::shared_ptr<const Scenario>, std::uint64_t>, std::string> sequence_ids_;
  std::list<OpenSequence> open_;  ///< kept from run to run
  CachePruned pruned_;
};

/// Claims `options.out`, lists the jobs there (with the plan that they are of, see
/// `JobStore::enter`, or else with the settings, see `JobStore::check_settings`), and does those of
/// the shard.
struct JobList {
  std::span<const Job> jobs;
  Shard shard = {};
  std::string plan = "";
  std::vector<std::string> settings = {};  ///< "key=value" on top of every scenario
  bool force = false;
};
Result<JobRun> run_jobs(const JobList& list, JobOptions options, const JobObserver& observer);

}  // namespace aims
