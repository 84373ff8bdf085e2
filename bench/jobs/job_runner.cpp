// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_runner.hpp"

#include <algorithm>
#include <utility>

#include "bench/jobs/job_schedule.hpp"

namespace aims {
namespace {

/// Units of a kind from which on their mean time is known well enough, at most a tenth of them all.
constexpr double kKnown = 3.0;

}  // namespace

std::optional<double> time_left(const KindOfWork& simulation, const KindOfWork& evaluation,
                                int processes) {
  double left_s = 0.0;
  for (const KindOfWork* kind : {&simulation, &evaluation}) {
    const auto total = static_cast<double>(kind->total);
    const double left = total - kind->done;
    if (left <= 0.0) continue;
    if (kind->done <= 0.0 || kind->done < std::min(kKnown, 0.1 * total)) return std::nullopt;
    left_s += left * kind->seconds / kind->done;
  }
  return left_s / processes;
}

namespace {

/// Sequences that stay open between runs: each holds its truth, 8 MB for four minutes.
constexpr std::size_t kOpenSequences = 32;

/// The sequences of jobs that other shards may still do.
std::set<std::string> shared_sequences(const JobList& list) {
  std::set<std::string> sequences;
  if (list.shard.count == 1) return sequences;
  std::set<std::pair<const Scenario*, std::uint64_t>> known;
  for (const Job& job : list.jobs) {
    if (!known.emplace(job.scenario.get(), job.seed).second) continue;
    sequences.insert(SequenceCache::id_of(*job.scenario, job.seed));
  }
  return sequences;
}

}  // namespace

JobRunner::JobRunner(JobOptions options, Evaluate evaluate)
    : options_(std::move(options)),
      evaluate_(std::move(evaluate)),
      store_(options_.out),
      cache_(options_.cache.empty() ? SequenceCache::default_folder() : options_.cache) {}

Result<JobRun> JobRunner::run(std::span<const Job> jobs, const JobObserver& observer) {
  return JobSchedule(*this, jobs, observer).run();
}

std::optional<JobResult> JobRunner::finished(const Job& job) {
  auto result = store_.find(job.id);
  if (!result || options_.redo) return std::nullopt;
  if (result->outcome != JobOutcome::kDone) return options_.retry ? std::nullopt : result;
  const JobOutputs& outputs = options_.outputs;
  const bool whole = job.recorded || (!outputs.trajectories && !outputs.weak_axis) ||
                     store_.has(job.id, sequence_id(job), outputs);
  return whole ? result : std::nullopt;
}

std::string JobRunner::sequence_id(const Job& job) {
  const auto key = std::pair(job.scenario, job.seed);
  const auto known = sequence_ids_.find(key);
  if (known != sequence_ids_.end()) return known->second;
  return sequence_ids_.emplace(key, SequenceCache::id_of(*job.scenario, job.seed)).first->second;
}

Result<const Sequence*> JobRunner::open(const std::string& id, const Scenario& scenario,
                                        std::uint64_t seed) {
  const auto same = [&id](const OpenSequence& each) { return each.id == id; };
  const auto known = std::find_if(open_.begin(), open_.end(), same);
  if (known != open_.end()) return known->sequence.get();
  // Without a lock the file may go while it is read, which takes nothing from who has it open.
  auto in_use = cache_.use(id);
  auto sequence = open_sequence(cache_.file_of(id), scenario, seed);
  if (!sequence) return tl::unexpected(sequence.error());
  if (open_.size() == kOpenSequences) open_.erase(open_.begin());
  open_.push_back({id, std::make_unique<const Sequence>(std::move(*sequence)), std::move(in_use)});
  return open_.back().sequence.get();
}

void JobRunner::prune(std::set<std::string> kept) {
  if (options_.cache_limit == 0) return;
  // Processes that still read a sequence keep its lock, which they have inherited.
  std::erase_if(open_, [&kept](const OpenSequence& each) { return !kept.contains(each.id); });
  const CachePruned now = cache_.prune(options_.cache_limit, kept);
  pruned_.sequences += now.sequences;
  pruned_.bytes += now.bytes;
  pruned_.left = now.left;
}

namespace {

Result<void> enter(const JobStore& store, const JobList& list) {
  if (!list.plan.empty()) return store.enter(list.jobs, list.plan, list.force);
  auto done = list.force ? Result<void>() : store.check_settings(list.settings);
  if (done) done = store.enter(list.jobs, "", list.force);
  return done ? store.keep_settings(list.settings) : done;
}

}  // namespace

Result<JobRun> run_jobs(const JobList& list, JobOptions options, const JobObserver& observer) {
  const auto claim = claim_store(options.out, list.shard);
  if (!claim) return tl::unexpected(claim.error());
  if (auto entered = enter(JobStore(options.out), list); !entered) {
    return tl::unexpected(entered.error());
  }
  options.kept_sequences = shared_sequences(list);
  return JobRunner(std::move(options)).run(part_of(list.jobs, list.shard), observer);
}

}  // namespace aims
