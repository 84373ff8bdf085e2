// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "bench/jobs/job_runner.hpp"
#include "bench/jobs/process_pool.hpp"
#include "core/stopwatch.hpp"

namespace aims {

/// One invocation of a runner: which process does what, and when.
class JobSchedule {
 public:
  JobSchedule(JobRunner& runner, std::span<const Job> jobs, const JobObserver& observer);

  Result<JobRun> run();

 private:
  /// One sequence and the jobs that wait for it; or one job on a recording, under the job's id.
  struct SequenceWork {
    enum class State { kMissing, kBeingMade, kReady };

    std::string id;
    std::vector<const Job*> jobs;
    std::size_t next = 0;  ///< the first job that was not started
    State state = State::kMissing;
    bool remade = false;  ///< its file could not be read, and was made once more

    const Scenario& scenario() const { return *jobs.front()->scenario; }
    std::uint64_t seed() const { return jobs.front()->seed; }
    /// Its file is needed by jobs that are not started.
    bool is_waited_for() const { return state != State::kReady || next < jobs.size(); }
    bool has_job() const { return state == State::kReady && next < jobs.size(); }
  };

  /// What a process does: simulate the sequence, or evaluate the job.
  struct Task {
    SequenceWork* sequence = nullptr;
    const Job* job = nullptr;  ///< none: the sequence itself
  };

  void add(const Job& job);
  Result<void> start_all();
  Result<void> start_job(SequenceWork& sequence);
  Result<void> start_recorded(SequenceWork& work);
  Result<void> start_sequence(SequenceWork& sequence);
  Result<void> start(Task task, double timeout_s, const ProcessPool::Work& work);
  Result<void> take(const EndedProcess& ended);
  Result<void> take_sequence(SequenceWork& sequence, const EndedProcess& ended, const Json& reply);
  Result<void> take_job(const Job& job, const EndedProcess& ended, const Json& reply);
  Result<void> fail(const Job& job, JobOutcome outcome, std::string message);
  void prune();
  void measure_work();
  bool notify();

  JobRunner& runner_;
  const JobObserver& observer_;
  ProcessPool pool_;
  std::vector<SequenceWork> sequences_;
  std::map<std::string, std::size_t> index_;  ///< of the sequences, by id
  std::vector<Task> tasks_;                   ///< by key
  JobProgress progress_;
  std::size_t steps_ = 0;       ///< jobs and sequences to be done
  std::size_t steps_done_ = 0;  ///< of them
  KindOfWork ended_simulation_;
  KindOfWork ended_evaluation_;
  JobRun run_;
  Stopwatch stopwatch_;
};

}  // namespace aims
