// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_schedule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

#include "bench/run/weak_axis_series.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/validity.hpp"
#include "core/files/csv.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr double kPatience = 0.2;  ///< between looks at the observer [s]

std::string text_of_reply(const Json& json) { return json_text(json, -1); }

/// In a process of its own: simulates a sequence.
std::string simulate(const SequenceCache& cache, const Scenario& scenario, std::uint64_t seed,
                     int threads, std::atomic<double>& part) {
  const auto made = cache.make(
      scenario, seed, [&part](double done) { part = done; }, threads);
  if (!made) return text_of_reply({{"error", made.error().message}});
  if (made->refusal) return text_of_reply({{"refusal", *made->refusal}});
  return text_of_reply({{"made", made->simulated}});
}

/// Of the process of a job.
std::string reply_of(const JobResult& result, const Result<void>& stored) {
  if (!stored) return text_of_reply({{"error", stored.error().message}});
  return text_of_reply({{"failed", result.outcome != JobOutcome::kDone},
                        {"invalid", invalid_reason(result.sequence).has_value()}});
}

/// Writes what is kept of a job besides its scores.
Result<void> write_outputs(const JobStore& store, const JobOutputs& wanted, const Job& job,
                           const std::string& sequence_id, const Sequence& sequence,
                           const EstimatorOutcome& outcome) {
  Result<void> written;
  const fs::path shared = store.sequence_of(sequence_id);
  const bool is_there = fs::exists(shared / *std::rbegin(kSequenceFiles));  // written last
  if (wanted.trajectories && !is_there) {
    fs::create_directories(shared);
    written = write_sequence(sequence, *job.scenario, shared);
  }
  const fs::path own = store.outputs_of(job.id);
  if (wanted.trajectories || wanted.weak_axis) fs::create_directories(own);
  if (written && wanted.trajectories) written = write_estimator(outcome, own, kEstimateName);
  if (written && wanted.weak_axis) {
    written = write_csv(own / kWeakAxisFile, weak_axis_table(sequence, outcome));
  }
  return written;
}

}  // namespace

JobSchedule::JobSchedule(JobRunner& runner, std::span<const Job> jobs, const JobObserver& observer)
    : runner_(runner), observer_(observer), pool_(runner.options_.jobs) {
  for (const Job& job : jobs) add(job);
  for (SequenceWork& sequence : sequences_) {
    const bool ready = sequence.jobs.front()->recorded || runner_.cache_.has(sequence.id);
    if (ready) sequence.state = SequenceWork::State::kReady;
    if (runner_.options_.simulate_only) sequence.next = sequence.jobs.size();
    progress_.total += sequence.jobs.size() - sequence.next;
    progress_.simulation.total += sequence.state == SequenceWork::State::kMissing ? 1 : 0;
  }
  progress_.evaluation.total = progress_.total;
  progress_.processes = runner_.options_.jobs;
  steps_ = progress_.simulation.total + progress_.total;
}

Result<JobRun> JobSchedule::run() {
  prune();
  while (run_.complete) {
    if (auto started = start_all(); !started) return tl::unexpected(started.error());
    if (pool_.is_idle()) break;
    for (const EndedProcess& ended : pool_.wait(kPatience)) {
      if (auto taken = take(ended); !taken) return tl::unexpected(taken.error());
    }
    run_.complete = notify();
  }
  run_.done = progress_.done;
  run_.failed = progress_.failed;
  run_.sequences = progress_.sequences;
  run_.pruned = runner_.pruned();
  return run_;
}

/// Adds a job to its sequence, unless it is done.
void JobSchedule::add(const Job& job) {
  if (const auto result = runner_.finished(job)) {
    ++run_.reused;
    run_.invalid += invalid_reason(result->sequence) ? 1 : 0;
    return;
  }
  const std::string id = job.recorded ? job.id : runner_.sequence_id(job);
  auto sequence = index_.find(id);
  if (sequence == index_.end()) {
    sequence = index_.emplace(id, sequences_.size()).first;
    sequences_.push_back({id, {}});
  }
  sequences_[sequence->second].jobs.push_back(&job);
}

/// Fills the pool: with jobs of the first sequence that is there, else with the next sequence, so
/// that processes work on few sequences at a time and share their memory.
Result<void> JobSchedule::start_all() {
  while (pool_.has_room()) {
    const auto ready = std::find_if(sequences_.begin(), sequences_.end(),
                                    [](const auto& sequence) { return sequence.has_job(); });
    const auto missing =
        std::find_if(sequences_.begin(), sequences_.end(), [](const SequenceWork& sequence) {
          return sequence.state == SequenceWork::State::kMissing;
        });
    if (ready == sequences_.end() && missing == sequences_.end()) return {};
    auto started = ready != sequences_.end() ? start_job(*ready) : start_sequence(*missing);
    if (!started) return started;
  }
  return {};
}

Result<void> JobSchedule::start_sequence(SequenceWork& sequence) {
  sequence.state = SequenceWork::State::kBeingMade;
  return start({&sequence, nullptr}, 0.0, [this, &sequence](std::atomic<double>& part) {
    return simulate(runner_.cache_, sequence.scenario(), sequence.seed(), runner_.options_.jobs,
                    part);
  });
}

Result<void> JobSchedule::start_recorded(SequenceWork& work) {
  const Job& job = *work.jobs[work.next++];
  const auto done = [this, &job](std::atomic<double>& part) {
    const Stopwatch stopwatch;
    JobResult result = job.recorded(part);
    result.wall_s = stopwatch.seconds();
    return reply_of(result, runner_.store_.put(job, result));
  };
  return start({&work, &job}, runner_.options_.timeout_s, done);
}

Result<void> JobSchedule::start_job(SequenceWork& work) {
  if (work.jobs.front()->recorded) return start_recorded(work);
  const auto open = runner_.open(work.id, work.scenario(), work.seed());
  if (!open && !work.remade) {  // e.g. cut short by a power failure
    work.remade = true;
    work.state = SequenceWork::State::kMissing;
    ++steps_;
    ++progress_.simulation.total;
    std::error_code ignored;
    fs::remove(runner_.cache_.file_of(work.id), ignored);
    return {};
  }
  if (!open) return tl::unexpected(open.error());
  const Job& job = *work.jobs[work.next++];
  const auto evaluated = [this, &job, &work, &sequence = **open](std::atomic<double>& part) {
    const Stopwatch stopwatch;
    JobResult result;
    const auto outcome = runner_.evaluate_(sequence, *job.scenario, text_of(job.estimator),
                                           [&part](double done) { part = done; });
    Result<void> stored;
    if (outcome) {
      result.scores = estimator_json(*outcome);
      result.sequence = sequence_json(sequence, *job.scenario, outcome->scores);
      stored =
          write_outputs(runner_.store_, runner_.options_.outputs, job, work.id, sequence, *outcome);
    } else {
      result.outcome = JobOutcome::kFailed;
      result.message = outcome.error().message;
    }
    result.wall_s = stopwatch.seconds();
    if (stored) stored = runner_.store_.put(job, result);
    return reply_of(result, stored);
  };
  return start({&work, &job}, runner_.options_.timeout_s, evaluated);
}

Result<void> JobSchedule::start(Task task, double timeout_s, const ProcessPool::Work& work) {
  tasks_.push_back(task);
  return pool_.start(tasks_.size() - 1, timeout_s, work);
}

Result<void> JobSchedule::take(const EndedProcess& ended) {
  const Task& task = tasks_[ended.key];
  Json reply = Json::object();
  if (ended.end == ProcessEnd::kReturned) reply = Json::parse(ended.text, nullptr, false);
  if (reply.contains("error")) return failure(reply["error"].get<std::string>());
  ++steps_done_;
  KindOfWork& kind = task.job == nullptr ? ended_simulation_ : ended_evaluation_;
  kind.done += 1.0;
  kind.seconds += ended.seconds;
  return task.job == nullptr ? take_sequence(*task.sequence, ended, reply)
                             : take_job(*task.job, ended, reply);
}

Result<void> JobSchedule::take_sequence(SequenceWork& sequence, const EndedProcess& ended,
                                        const Json& reply) {
  sequence.state = SequenceWork::State::kReady;
  progress_.sequences += reply.value("made", false) ? 1 : 0;
  if (reply.value("made", false)) prune();
  const bool crashed = ended.end != ProcessEnd::kReturned;
  if (!crashed && !reply.contains("refusal")) return {};
  const std::string why = crashed ? ended.text : reply["refusal"].get<std::string>();
  while (sequence.next < sequence.jobs.size()) {
    ++steps_done_;
    auto stored = fail(*sequence.jobs[sequence.next++], JobOutcome::kNotSimulated,
                       "the sequence could not be simulated: " + why);
    if (!stored) return stored;
  }
  return {};
}

Result<void> JobSchedule::take_job(const Job& job, const EndedProcess& ended, const Json& reply) {
  if (ended.end == ProcessEnd::kTimedOut) {
    return fail(job, JobOutcome::kTimedOut,
                fmt::format("stopped after {:g} s", runner_.options_.timeout_s));
  }
  if (ended.end == ProcessEnd::kCrashed) return fail(job, JobOutcome::kCrashed, ended.text);
  ++progress_.done;
  if (reply.value("failed", false)) ++progress_.failed;
  if (reply.value("invalid", false)) ++run_.invalid;
  return {};
}

/// Keeps the cache within its limit, but for sequences that are still to be read.
void JobSchedule::prune() {
  std::set<std::string> kept = runner_.options_.kept_sequences;
  for (const SequenceWork& sequence : sequences_) {
    if (runner_.options_.simulate_only || sequence.is_waited_for()) kept.insert(sequence.id);
  }
  runner_.prune(std::move(kept));
}

/// Stores what its own process could not.
Result<void> JobSchedule::fail(const Job& job, JobOutcome outcome, std::string message) {
  ++progress_.done;
  ++progress_.failed;
  JobResult result;
  result.outcome = outcome;
  result.message = std::move(message);
  return runner_.store_.put(job, result);
}

/// What has ended and what is under way.
void JobSchedule::measure_work() {
  KindOfWork& simulation = progress_.simulation;
  KindOfWork& evaluation = progress_.evaluation;
  simulation = {simulation.total, ended_simulation_.done, ended_simulation_.seconds};
  evaluation = {evaluation.total, ended_evaluation_.done, ended_evaluation_.seconds};
  for (const ProcessPool::UnderWay& each : pool_.under_way()) {
    KindOfWork& kind = tasks_[each.key].job == nullptr ? simulation : evaluation;
    kind.done += each.part;
    kind.seconds += each.seconds;
  }
}

bool JobSchedule::notify() {
  progress_.elapsed_s = stopwatch_.seconds();
  measure_work();
  const double done = static_cast<double>(steps_done_) + pool_.part_under_way();
  const double fraction = steps_ == 0 ? 1.0 : std::min(1.0, done / static_cast<double>(steps_));
  progress_.fraction = std::max(progress_.fraction, fraction);  // a sequence made anew adds a step
  progress_.left_s = time_left(progress_.simulation, progress_.evaluation, progress_.processes);
  return observer_(progress_);
}

}  // namespace aims
