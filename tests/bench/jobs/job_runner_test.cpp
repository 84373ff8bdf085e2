// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_runner.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>

#include "tests/bench/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::shared;
using testing::short_walk;

bool keep_going(const JobProgress&) { return true; }

Job job_of(const std::shared_ptr<const Scenario>& scenario, const std::string& spec,
           std::uint64_t seed = 1) {
  return make_job(scenario, seed, parse_estimator_spec(spec).value());
}

/// An estimator that does what its label says, in place of a real one.
Result<EstimatorOutcome> pretended(const Sequence&, const Scenario&, const std::string& spec,
                                   const PartObserver&) {
  if (spec.find("eta=1") != std::string::npos) std::raise(SIGSEGV);
  while (spec.find("eta=2") != std::string::npos) ::pause();
  if (spec.find("eta=3") != std::string::npos) return failure("not today");
  EstimatorOutcome outcome;
  outcome.scores.success = true;
  return outcome;
}

class Jobs : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    sequences_ = new TemporaryFolder;
    ASSERT_TRUE(SequenceCache(sequences_->path()).make(short_walk(), 1));
  }
  static void TearDownTestSuite() { delete sequences_; }

  JobOptions options(int jobs = 1) const {
    JobOptions options;
    options.out = folder_.path() / fs::path("out");
    options.cache = sequences_->path();
    options.jobs = jobs;
    return options;
  }

  static TemporaryFolder* sequences_;
  TemporaryFolder folder_;
};

TemporaryFolder* Jobs::sequences_ = nullptr;

TEST_F(Jobs, OnRecordingsNeedNoSequenceAndOneThatCrashesIsAResult) {
  const auto scenario = shared(short_walk());
  std::vector<Job> jobs = {job_of(scenario, "aims"), job_of(scenario, "lio"),
                           job_of(scenario, "leg")};
  jobs[0].recorded = [](std::atomic<double>& part) {
    part = 0.5;
    JobResult result;
    result.scores = {{"success", true}};
    return result;
  };
  jobs[1].recorded = [](std::atomic<double>&) -> JobResult {
    std::raise(SIGSEGV);
    return {};
  };
  jobs[2].recorded = [](std::atomic<double>&) -> JobResult {
    while (true) ::pause();
  };
  JobOptions some = options();
  some.cache = folder_.path() / "cache";
  JobRunner runner(some);
  const auto done = runner.run(std::span(jobs).first(2), keep_going);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->done, 2U);
  EXPECT_EQ(done->failed, 1U);
  EXPECT_EQ(done->sequences, 0U);
  EXPECT_EQ(runner.store().find(jobs[0].id)->scores["success"], true);
  EXPECT_EQ(runner.store().find(jobs[1].id)->outcome, JobOutcome::kCrashed);
  some.timeout_s = 0.2;
  ASSERT_TRUE(JobRunner(some).run(std::span(jobs).last(1), keep_going));
  EXPECT_EQ(runner.store().find(jobs[2].id)->outcome, JobOutcome::kTimedOut);
  EXPECT_EQ(runner.run(jobs, keep_going)->reused, 3U);
}

TEST_F(Jobs, GiveTheSameScoresForAnyNumberOfJobsAndAreNeverRepeated) {
  const auto scenario = shared(short_walk());
  std::vector<Job> jobs;
  for (const char* spec : {"aims", "aims+degeneracy.eta=1", "lio", "leg"}) {
    jobs.push_back(job_of(scenario, spec));
  }
  std::map<std::string, Json> first;
  for (const int processes : {1, 2}) {
    JobOptions some = options(processes);
    some.out = folder_.path() / std::to_string(processes);
    JobRunner runner(some);
    const auto done = runner.run(jobs, keep_going);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->done, 4U);
    EXPECT_EQ(done->failed, 0U);
    EXPECT_EQ(done->sequences, 0U) << "the sequence was there";
    for (const Job& job : jobs) {
      auto result = runner.store().find(job.id);
      ASSERT_TRUE(result);
      EXPECT_EQ(score_in(*result, "success"), 1.0);
      for (const char* times : {"time_per_scan_ms", "cpu_per_scan_ms"}) result->scores.erase(times);
      const auto [known, added] = first.emplace(job.id, result->scores);
      EXPECT_EQ(known->second, result->scores);
    }
    const auto again = runner.run(jobs, keep_going);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->done, 0U);
    EXPECT_EQ(again->reused, 4U);
  }
}

TEST_F(Jobs, ThatCrashHangOrFailAreRecordedAndStopNothing) {
  const auto scenario = shared(short_walk());
  std::vector<Job> jobs;
  for (const char* eta : {"1", "2", "3", "4"}) {
    jobs.push_back(job_of(scenario, std::string("aims+degeneracy.eta=") + eta));
  }
  JobOptions impatient = options(2);
  impatient.timeout_s = 0.2;
  JobRunner runner(impatient, pretended);
  const auto run = runner.run(jobs, keep_going);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->done, 4U);
  EXPECT_EQ(run->failed, 3U);
  const auto result = [&](int i) { return runner.store().find(jobs[i].id).value(); };
  EXPECT_EQ(result(0).outcome, JobOutcome::kCrashed);
  EXPECT_EQ(result(0).message, "signal 11 (Segmentation fault)");
  EXPECT_EQ(result(1).outcome, JobOutcome::kTimedOut);
  EXPECT_EQ(result(1).message, "stopped after 0.2 s");
  EXPECT_EQ(result(2).outcome, JobOutcome::kFailed);
  EXPECT_EQ(result(2).message, "not today");
  EXPECT_EQ(result(3).outcome, JobOutcome::kDone);
  EXPECT_FALSE(score_in(result(0), "success"));

  EXPECT_EQ(runner.run(jobs, keep_going)->reused, 4U) << "a failure is a result";
  impatient.retry = true;
  EXPECT_EQ(JobRunner(impatient, pretended).run(jobs, keep_going)->done, 3U);
}

TEST_F(Jobs, OnAWalkThatCannotBeSimulatedFailWithTheReason) {
  const auto scenario = shared(testing::in_wall());
  const std::vector<Job> jobs = {job_of(scenario, "aims"), job_of(scenario, "leg"),
                                 job_of(shared(short_walk()), "leg")};
  JobRunner runner(options(2));
  const auto run = runner.run(jobs, keep_going);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->failed, 2U);
  const auto result = runner.store().find(jobs[0].id);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->outcome, JobOutcome::kNotSimulated);
  EXPECT_NE(result->message.find("the sequence could not be simulated: "), std::string::npos);
  EXPECT_EQ(runner.store().find(jobs[2].id)->outcome, JobOutcome::kDone);
}

TEST_F(Jobs, AreDoneAgainWhenAnOutputIsWantedThatTheyLack) {
  const std::vector<Job> jobs = {job_of(shared(short_walk()), "aims")};
  ASSERT_TRUE(JobRunner(options()).run(jobs, keep_going));
  JobOptions more = options();
  more.outputs = {.trajectories = true, .weak_axis = true};
  JobRunner runner(more);
  EXPECT_EQ(runner.run(jobs, keep_going)->done, 1U);
  const fs::path own = runner.store().outputs_of(jobs[0].id);
  for (const char* name :
       {"estimate.tum", "estimate.map.ply", "estimate.diagnostics.csv", "weak_axis.csv"}) {
    EXPECT_TRUE(fs::exists(own / name)) << name;
  }
  EXPECT_EQ(runner.run(jobs, keep_going)->reused, 1U);
  fs::remove(own / "weak_axis.csv");
  EXPECT_EQ(runner.run(jobs, keep_going)->done, 1U);
  EXPECT_EQ(JobRunner(options()).run(jobs, keep_going)->reused, 1U) << "scores alone are there";
}

TEST_F(Jobs, TellHowFarTheyAre) {
  const std::vector<Job> jobs = {job_of(shared(short_walk()), "leg", 3)};
  double last = 0.0;
  const auto run = JobRunner(options()).run(jobs, [&](const JobProgress& progress) {
    EXPECT_GE(progress.fraction, last);
    last = progress.fraction;
    return true;
  });
  ASSERT_TRUE(run);
  EXPECT_EQ(last, 1.0);
}

TEST_F(Jobs, AreDoneAgainWhenTheirFileIsBroken) {
  const std::vector<Job> jobs = {job_of(shared(short_walk()), "leg")};
  JobRunner runner(options());
  ASSERT_TRUE(runner.run(jobs, keep_going));
  const fs::path file = runner.store().path() / "jobs" / (jobs[0].id + ".json");
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_EQ(runner.run(jobs, keep_going)->done, 1U);
  EXPECT_TRUE(runner.store().find(jobs[0].id));
}

TEST_F(Jobs, MakeABrokenWalkAnew) {
  const TemporaryFolder cache;
  const fs::path file = cache.path() / (SequenceCache::id_of(short_walk(), 1) + ".sequence");
  std::ofstream(file) << "aimsseqn, but not more";
  JobOptions other = options();
  other.cache = cache.path();
  const std::vector<Job> jobs = {job_of(shared(short_walk()), "leg")};
  const auto run = JobRunner(other).run(jobs, keep_going);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->sequences, 1U);
  EXPECT_EQ(run->failed, 0U);
}

TEST_F(Jobs, KeepTheCacheWithinItsLimitButForSequencesThatAreWaitedFor) {
  const TemporaryFolder cache;
  const fs::path old = cache.path() / "0123456789abcdef.sequence";
  std::ofstream(old) << "of an earlier sweep";
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(1));
  const fs::path other = cache.path() / "fedcba9876543210.sequence";
  std::ofstream(other) << "of another shard";
  JobOptions small = options();
  small.cache = cache.path();
  small.cache_limit = 1;
  small.kept_sequences = {"fedcba9876543210"};
  const auto scenario = shared(short_walk());
  const std::vector<Job> jobs = {job_of(scenario, "leg", 1), job_of(scenario, "leg", 2)};
  JobRunner runner(small);
  const auto run = runner.run(jobs, keep_going);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->failed, 0U);
  EXPECT_EQ(run->sequences, 2U);
  const auto has = [&](std::uint64_t seed) {
    return SequenceCache(cache.path()).has(SequenceCache::id_of(*scenario, seed));
  };
  EXPECT_EQ(run->pruned.sequences, 2U) << "an old one, and that of the first job after it ended";
  EXPECT_FALSE(has(1));
  EXPECT_TRUE(has(2)) << "until others are made";
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(other));

  small.cache_limit = 0;
  std::ofstream(old) << "of an earlier sweep";
  small.out = folder_.path() / "again";
  ASSERT_TRUE(JobRunner(small).run(jobs, keep_going));
  EXPECT_TRUE(fs::exists(old)) << "any size";
}

TEST_F(Jobs, EndWhenTheObserverHasEnough) {
  const auto scenario = shared(short_walk());
  std::vector<Job> jobs;
  for (const char* eta : {"2", "2.5"}) {  // both hang
    jobs.push_back(job_of(scenario, std::string("aims+degeneracy.eta=") + eta));
  }
  const auto run =
      JobRunner(options(), pretended).run(jobs, [](const JobProgress&) { return false; });
  ASSERT_TRUE(run);
  EXPECT_FALSE(run->complete);
  EXPECT_EQ(run->done, 0U);
}

TEST_F(Jobs, AFolderThatCannotBeWrittenEndsTheWorkAndIsNamed) {
  JobOptions blocked = options();
  std::ofstream(folder_.path() / "out") << "a file where the folder should be";
  const std::vector<Job> jobs = {job_of(shared(short_walk()), "leg")};
  const auto run = JobRunner(blocked).run(jobs, keep_going);
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().message.find((folder_.path() / "out").string()), std::string::npos);
}

}  // namespace
}  // namespace aims
