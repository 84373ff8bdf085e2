// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_store.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "bench/jobs/stored_results.hpp"
#include "tests/bench/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::shared;
using testing::short_walk;

TEST(Shard, TogetherAreAllJobsEachOnce) {
  const std::vector<Job> jobs(11);
  for (const int count : {1, 2, 3, 11, 20}) {
    std::size_t next = 0;
    for (int index = 1; index <= count; ++index) {
      const auto part = part_of(jobs, {index, count});
      EXPECT_EQ(part.data(), jobs.data() + next);
      next += part.size();
      EXPECT_LE(part.size(), 11U / count + 1);
    }
    EXPECT_EQ(next, jobs.size());
  }
  EXPECT_EQ(parse_shard("2/8")->index, 2);
  for (const char* wrong : {"", "2", "0/4", "5/4", "a/4", "1/4x", "-1/4"}) {
    EXPECT_FALSE(parse_shard(wrong)) << wrong;
  }
}

class Store : public ::testing::Test {
 protected:
  std::vector<Job> two_jobs() const {
    const auto scenario = shared(short_walk());
    return {make_job(scenario, 1, parse_estimator_spec("leg").value()),
            make_job(scenario, 1, parse_estimator_spec("slow=leg+queue.max_ahead=100").value())};
  }

  static JobResult done(double ate) {
    JobResult result;
    result.scores = {{"success", true}, {"ate_m", ate}};
    result.sequence = {{"simulated_s", 4.0}};
    return result;
  }

  void expect_refused(const std::string& part, const Shard& shard = {}) const {
    const auto claim = claim_store(out_, shard);
    ASSERT_FALSE(claim);
    EXPECT_NE(claim.error().message.find(part), std::string::npos) << claim.error().message;
    EXPECT_NE(claim.error().message.find(out_.string()), std::string::npos);
  }

  TemporaryFolder folder_;
  fs::path out_ = folder_.path() / "out";
};

TEST_F(Store, ReadsBackItsListAndResultsAsRecords) {
  ASSERT_TRUE(claim_store(out_));
  const JobStore store(out_);
  const std::vector<Job> jobs = two_jobs();
  ASSERT_TRUE(store.enter(jobs, "", false));
  ASSERT_TRUE(store.put(jobs[0], done(0.1)));
  ASSERT_TRUE(store.put(jobs[1], done(0.2)));
  const auto listed = store.listed();
  ASSERT_TRUE(listed) << listed.error().message;
  ASSERT_EQ(listed->size(), 2U);
  EXPECT_EQ((*listed)[1].id, jobs[1].id);
  EXPECT_EQ((*listed)[1].label, "slow");
  EXPECT_EQ((*listed)[1].estimator, "leg+queue.max_ahead=100");
  const auto results = read_results(out_);
  ASSERT_TRUE(results) << results.error().message;
  const RunRecord& record = results->at("short").at(0);
  EXPECT_EQ(find_score(record, "leg", "ate_m"), 0.1);
  EXPECT_EQ(find_score(record, "slow", "ate_m"), 0.2);
  EXPECT_EQ(record.scores["simulated_s"], 4.0);
}

TEST_F(Store, RecordsFailuresWithoutScores) {
  ASSERT_TRUE(claim_store(out_));
  const JobStore store(out_);
  const std::vector<Job> jobs = two_jobs();
  ASSERT_TRUE(store.enter(jobs, "", false));
  JobResult crashed;
  crashed.outcome = JobOutcome::kCrashed;
  crashed.message = "signal 11";
  ASSERT_TRUE(store.put(jobs[0], crashed));
  const auto alone = read_results(out_);
  ASSERT_TRUE(alone) << "a crash is a lost success, also where nobody else has a result";
  EXPECT_TRUE(failed_in(alone->at("short").at(0), "leg"));
  ASSERT_TRUE(store.put(jobs[1], done(0.2)));
  const auto results = read_results(out_);
  ASSERT_TRUE(results);
  EXPECT_FALSE(find_score(results->at("short").at(0), "leg", "ate_m"));
  JobResult unknown;
  unknown.outcome = JobOutcome::kNotSimulated;
  for (const Job& job : jobs) ASSERT_TRUE(store.put(job, unknown));
  EXPECT_FALSE(read_results(out_)) << "no failure of an estimator";
}

TEST_F(Store, RefusesAFolderInUseOrOfSomethingElse) {
  {
    const auto alone = claim_store(out_);
    ASSERT_TRUE(alone);
    expect_refused("in use by another aims command");
    expect_refused("in use by another aims command", {1, 2});
  }
  {
    const auto first = claim_store(out_, {1, 2});
    ASSERT_TRUE(first);
    expect_refused("another process works on shard 1/2", {1, 2});
    EXPECT_TRUE(claim_store(out_, {2, 2})) << "another shard may work beside it";
  }
  out_ = folder_.path() / "thesis";
  fs::create_directories(out_);
  std::ofstream(out_ / "thesis.tex") << "years of work";
  expect_refused("no folder of aims results");
}

}  // namespace
}  // namespace aims
