// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "bench/jobs/process_pool.hpp"
#include "core/stopwatch.hpp"

namespace aims {
namespace {

/// Sequences that stay open between runs: each holds its truth, 8 MB for four minutes.
constexpr std::size_t kOpenSequences = 32;
constexpr double kPatience = 0.2;  ///< between looks at the observer [s]

/// One sequence and the jobs that wait for it.
struct SequenceWork {
  enum class State { kMissing, kBeingMade, kReady };

  std::string id;
  std::vector<const Job*> jobs;
  std::size_t next = 0;  ///< the first job that was not started
  State state = State::kMissing;
  bool remade = false;  ///< its file could not be read, and was made once more

  const Scenario& scenario() const { return *jobs.front()->scenario; }
  std::uint64_t seed() const { return jobs.front()->seed; }
  /// Its sequence is needed by jobs that are not started.
  bool is_waited_for() const { return state != State::kReady || next < jobs.size(); }
  bool has_job() const { return state == State::kReady && next < jobs.size(); }
};

/// What a process does: simulate the sequence, or evaluate the job.
struct Task {
  SequenceWork* sequence = nullptr;
  const Job* job = nullptr;  ///< none: the sequence itself
};

std::string reply(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// In a process of its own: simulates a sequence.
std::string make_sequence(const SequenceCache& cache, const SequenceWork& sequence) {
  const auto made = cache.make(sequence.scenario(), sequence.seed());
  if (!made) return reply({{"error", made.error().message}});
  if (made->refusal) return reply({{"refusal", *made->refusal}});
  return reply({{"made", made->simulated}});
}

/// In a process of its own: evaluates a job and stores what it came to.
std::string do_job(const Sequence& sequence, const Job& job, const Evaluate& evaluate,
                    const JobResults& folder) {
  const Stopwatch stopwatch;
  JobResult result;
  const auto outcome = evaluate(sequence, *job.scenario, text_of(job.estimator));
  if (outcome) {
    result.scores = estimator_json(*outcome);
  } else {
    result.outcome = JobOutcome::kFailed;
    result.message = outcome.error().message;
  }
  result.wall_s = stopwatch.seconds();
  if (auto stored = folder.put(job, result); !stored) {
    return reply({{"error", stored.error().message}});
  }
  return reply({{"failed", result.outcome != JobOutcome::kDone}});
}

}  // namespace

/// One invocation: which process does what, and when.
class JobRunner::Schedule {
 public:
  Schedule(JobRunner& runner, std::span<const Job> jobs, const JobObserver& observer)
      : runner_(runner), observer_(observer), pool_(runner.options_.jobs) {
    for (const Job& job : jobs) add(job);
    for (SequenceWork& sequence : sequences_) {
      if (runner_.cache_.has(sequence.id)) sequence.state = SequenceWork::State::kReady;
      if (runner_.options_.simulate_only) sequence.next = sequence.jobs.size();
      progress_.total += sequence.jobs.size() - sequence.next;
    }
  }

  Result<JobRun> run() {
    prune();
    while (run_.complete) {
      if (auto started = start_all(); !started) return tl::unexpected(started.error());
      if (pool_.is_idle()) break;
      for (const EndedProcess& ended : pool_.wait(kPatience)) {
        if (auto taken = take(ended); !taken) return tl::unexpected(taken.error());
      }
      run_.complete = tell();
    }
    run_.done = progress_.done;
    run_.failed = progress_.failed;
    run_.sequences = progress_.sequences;
    run_.pruned = runner_.pruned();
    return run_;
  }

 private:
  /// Adds a job to its sequence, unless it is done.
  void add(const Job& job) {
    const auto result = runner_.folder_.find(job.id);
    const bool again = result && result->outcome != JobOutcome::kDone && runner_.options_.retry;
    if (result && !again) {
      ++run_.reused;
      return;
    }
    const std::string id = runner_.sequence_id(job);
    auto sequence = index_.find(id);
    if (sequence == index_.end()) {
      sequence = index_.emplace(id, sequences_.size()).first;
      sequences_.push_back({id, {}});
    }
    sequences_[sequence->second].jobs.push_back(&job);
  }

  /// Fills the pool: with jobs of the first sequence that is there, else with the next sequence, so that
  /// processes work on few sequences at a time and share their memory.
  Result<void> start_all() {
    while (pool_.has_room()) {
      const auto job = std::find_if(sequences_.begin(), sequences_.end(),
                                     [](const SequenceWork& sequence) { return sequence.has_job(); });
      const auto missing = std::find_if(sequences_.begin(), sequences_.end(), [](const SequenceWork& sequence) {
        return sequence.state == SequenceWork::State::kMissing;
      });
      if (job != sequences_.end()) {
        if (auto started = start_job(*job); !started) return started;
      } else if (missing != sequences_.end()) {
        missing->state = SequenceWork::State::kBeingMade;
        auto started = start({&*missing, nullptr}, 0.0,
                             [this, &sequence = *missing] { return make_sequence(runner_.cache_, sequence); });
        if (!started) return started;
      } else {
        return {};
      }
    }
    return {};
  }

  Result<void> start_job(SequenceWork& sequence) {
    const auto open = runner_.open(sequence.id, sequence.scenario());
    if (!open && !sequence.remade) {  // e.g. cut short by a power failure
      sequence.remade = true;
      sequence.state = SequenceWork::State::kMissing;
      std::error_code ignored;
      std::filesystem::remove(runner_.cache_.file_of(sequence.id), ignored);
      return {};
    }
    if (!open) return tl::unexpected(open.error());
    const Job& job = *sequence.jobs[sequence.next++];
    return start({&sequence, &job}, runner_.options_.timeout_s, [this, &job, sequence = *open] {
      return do_job(*sequence, job, runner_.evaluate_, runner_.folder_);
    });
  }

  Result<void> start(Task task, double timeout_s, const std::function<std::string()>& work) {
    tasks_.push_back(task);
    return pool_.start(tasks_.size() - 1, timeout_s, work);
  }

  Result<void> take(const EndedProcess& ended) {
    const Task& task = tasks_[ended.key];
    Json said = Json::object();
    if (ended.end == ProcessEnd::kReturned) said = Json::parse(ended.text, nullptr, false);
    if (said.contains("error")) return failure(said["error"].get<std::string>());
    return task.job == nullptr ? take_sequence(*task.sequence, ended, said)
                                : take_job(*task.job, ended, said);
  }

  Result<void> take_sequence(SequenceWork& sequence, const EndedProcess& ended, const Json& said) {
    sequence.state = SequenceWork::State::kReady;
    progress_.sequences += said.value("made", false) ? 1 : 0;
    if (said.value("made", false)) prune();
    const bool crashed = ended.end != ProcessEnd::kReturned;
    if (!crashed && !said.contains("refusal")) return {};
    const std::string why = crashed ? ended.text : said["refusal"].get<std::string>();
    while (sequence.next < sequence.jobs.size()) {
      auto stored = fail(*sequence.jobs[sequence.next++], JobOutcome::kFailed,
                         "the sequence could not be simulated: " + why);
      if (!stored) return stored;
    }
    return {};
  }

  Result<void> take_job(const Job& job, const EndedProcess& ended, const Json& said) {
    if (ended.end == ProcessEnd::kTimedOut) {
      return fail(job, JobOutcome::kTimedOut,
                  fmt::format("stopped after {:g} s", runner_.options_.timeout_s));
    }
    if (ended.end == ProcessEnd::kCrashed) return fail(job, JobOutcome::kCrashed, ended.text);
    ++progress_.done;
    if (said.value("failed", false)) ++progress_.failed;
    return {};
  }

  /// Keeps the cache within its limit, but for sequences that are still to be read.
  void prune() {
    std::set<std::string> kept = runner_.options_.kept_sequences;
    for (const SequenceWork& sequence : sequences_) {
      if (runner_.options_.simulate_only || sequence.is_waited_for()) kept.insert(sequence.id);
    }
    runner_.prune(std::move(kept));
  }

  /// Stores what its own process could not.
  Result<void> fail(const Job& job, JobOutcome outcome, std::string message) {
    ++progress_.done;
    ++progress_.failed;
    JobResult result;
    result.outcome = outcome;
    result.message = std::move(message);
    return runner_.folder_.put(job, result);
  }

  bool tell() {
    progress_.elapsed_s = stopwatch_.seconds();
    progress_.left_s.reset();
    if (progress_.done > 0) {
      progress_.left_s = progress_.elapsed_s *
                         static_cast<double>(progress_.total - progress_.done) /
                         static_cast<double>(progress_.done);
    }
    return observer_(progress_);
  }

  JobRunner& runner_;
  const JobObserver& observer_;
  ProcessPool pool_;
  std::vector<SequenceWork> sequences_;
  std::map<std::string, std::size_t> index_;  ///< of the sequences, by id
  std::vector<Task> tasks_;                   ///< by key
  JobProgress progress_;
  JobRun run_;
  Stopwatch stopwatch_;
};

JobRunner::JobRunner(JobOptions options, Evaluate evaluate)
    : options_(std::move(options)),
      evaluate_(std::move(evaluate)),
      folder_(options_.folder),
      cache_(options_.cache) {}

Result<JobRun> JobRunner::run(std::span<const Job> jobs, const JobObserver& observer) {
  return Schedule(*this, jobs, observer).run();
}

std::string JobRunner::sequence_id(const Job& job) {
  const auto key = std::pair(job.scenario, job.seed);
  const auto known = sequence_ids_.find(key);
  if (known != sequence_ids_.end()) return known->second;
  return sequence_ids_.emplace(key, SequenceCache::id_of(*job.scenario, job.seed)).first->second;
}

Result<const Sequence*> JobRunner::open(const std::string& id, const Scenario& scenario) {
  const auto same = [&id](const OpenSequence& each) { return each.id == id; };
  const auto known = std::find_if(open_.begin(), open_.end(), same);
  if (known != open_.end()) return known->sequence.get();
  // Without a lock the sequence may go while it is read, which takes nothing from who has it open.
  auto in_use = cache_.use(id);
  auto sequence = open_sequence(cache_.file_of(id), scenario);
  if (!sequence) return tl::unexpected(sequence.error());
  if (open_.size() == kOpenSequences) open_.erase(open_.begin());
  open_.push_back({id, std::make_unique<const Sequence>(std::move(*sequence)), std::move(in_use)});
  return open_.back().sequence.get();
}

void JobRunner::prune(std::set<std::string> kept) {
  if (options_.cache_limit == 0) return;
  const CachePruned now = cache_.prune(options_.cache_limit, kept);
  pruned_.sequences += now.sequences;
  pruned_.bytes += now.bytes;
  pruned_.left = now.left;
}

}  // namespace aims
