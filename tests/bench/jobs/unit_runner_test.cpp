// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/unit_runner.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include "tests/bench/jobs/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::shared;
using testing::short_walk;

bool keep_going(const UnitProgress&) { return true; }

SweepUnit unit_of(const std::shared_ptr<const Scenario>& scenario, const std::string& spec,
                  std::uint64_t seed = 1) {
  return make_unit(scenario, seed, parse_estimator_spec(spec).value());
}

/// An estimator that does what its label says, in place of a real one.
Result<EstimatorOutcome> pretended(const RecordedWalk&, const Scenario&, const std::string& spec) {
  if (spec.find("eta=1") != std::string::npos) std::raise(SIGSEGV);
  while (spec.find("eta=2") != std::string::npos) ::pause();
  if (spec.find("eta=3") != std::string::npos) return failure("not today");
  EstimatorOutcome outcome;
  outcome.scores.success = true;
  return outcome;
}

class Units : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    walks_ = new TemporaryFolder;
    ASSERT_TRUE(WalkCache(walks_->path()).make(short_walk(), 1));
  }
  static void TearDownTestSuite() { delete walks_; }

  UnitOptions options(int jobs = 1) const {
    UnitOptions options;
    options.units = folder_.path() / fs::path("units");
    options.cache = walks_->path();
    options.jobs = jobs;
    return options;
  }

  static TemporaryFolder* walks_;
  TemporaryFolder folder_;
};

TemporaryFolder* Units::walks_ = nullptr;

TEST_F(Units, GiveTheSameScoresForAnyNumberOfJobsAndAreNeverRepeated) {
  const auto scenario = shared(short_walk());
  std::vector<SweepUnit> units;
  for (const char* spec : {"aims", "aims+degeneracy.eta=1", "lio", "leg"}) {
    units.push_back(unit_of(scenario, spec));
  }
  std::map<std::string, Json> first;
  for (const int jobs : {1, 2}) {
    UnitOptions some = options(jobs);
    some.units = folder_.path() / std::to_string(jobs);
    UnitRunner runner(some);
    const auto done = runner.run(units, keep_going);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->done, 4U);
    EXPECT_EQ(done->failed, 0U);
    EXPECT_EQ(done->walks, 0U) << "the walk was there";
    for (const SweepUnit& unit : units) {
      auto result = runner.folder().find(unit.id);
      ASSERT_TRUE(result);
      EXPECT_EQ(score_in(*result, "success"), 1.0);
      result->scores.erase("time_per_scan_ms");
      const auto [known, added] = first.emplace(unit.id, result->scores);
      EXPECT_EQ(known->second, result->scores);
    }
    const auto again = runner.run(units, keep_going);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->done, 0U);
    EXPECT_EQ(again->reused, 4U);
  }
}

TEST_F(Units, ThatCrashHangOrFailAreRecordedAndStopNothing) {
  const auto scenario = shared(short_walk());
  std::vector<SweepUnit> units;
  for (const char* eta : {"1", "2", "3", "4"}) {
    units.push_back(unit_of(scenario, std::string("aims+degeneracy.eta=") + eta));
  }
  UnitOptions impatient = options(2);
  impatient.timeout_s = 0.2;
  UnitRunner runner(impatient, pretended);
  const auto run = runner.run(units, keep_going);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->done, 4U);
  EXPECT_EQ(run->failed, 3U);
  const auto result = [&](int i) { return runner.folder().find(units[i].id).value(); };
  EXPECT_EQ(result(0).outcome, UnitOutcome::kCrashed);
  EXPECT_EQ(result(0).message, "signal 11 (Segmentation fault)");
  EXPECT_EQ(result(1).outcome, UnitOutcome::kTimedOut);
  EXPECT_EQ(result(1).message, "stopped after 0.2 s");
  EXPECT_EQ(result(2).outcome, UnitOutcome::kFailed);
  EXPECT_EQ(result(2).message, "not today");
  EXPECT_EQ(result(3).outcome, UnitOutcome::kDone);
  EXPECT_FALSE(score_in(result(0), "success"));

  EXPECT_EQ(runner.run(units, keep_going)->reused, 4U) << "a failure is a result";
  impatient.retry = true;
  EXPECT_EQ(UnitRunner(impatient, pretended).run(units, keep_going)->done, 3U);
}

TEST_F(Units, OnAWalkThatCannotBeSimulatedFailWithTheReason) {
  const auto scenario = shared(testing::in_wall());
  const std::vector<SweepUnit> units = {unit_of(scenario, "aims"), unit_of(scenario, "leg"),
                                        unit_of(shared(short_walk()), "leg")};
  UnitRunner runner(options(2));
  const auto run = runner.run(units, keep_going);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->failed, 2U);
  const auto result = runner.folder().find(units[0].id);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->outcome, UnitOutcome::kFailed);
  EXPECT_NE(result->message.find("the walk could not be simulated: "), std::string::npos);
  EXPECT_EQ(runner.folder().find(units[2].id)->outcome, UnitOutcome::kDone);
}

TEST_F(Units, AreDoneAgainWhenTheirFileIsBroken) {
  const std::vector<SweepUnit> units = {unit_of(shared(short_walk()), "leg")};
  UnitRunner runner(options());
  ASSERT_TRUE(runner.run(units, keep_going));
  const fs::path file = runner.folder().path() / (units[0].id + ".json");
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_EQ(runner.run(units, keep_going)->done, 1U);
  EXPECT_TRUE(runner.folder().find(units[0].id));
}

TEST_F(Units, MakeABrokenWalkAnew) {
  const TemporaryFolder cache;
  const fs::path file = cache.path() / (WalkCache::id_of(short_walk(), 1) + ".walk");
  std::ofstream(file) << "aimswalk, but not more";
  UnitOptions other = options();
  other.cache = cache.path();
  const std::vector<SweepUnit> units = {unit_of(shared(short_walk()), "leg")};
  const auto run = UnitRunner(other).run(units, keep_going);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->walks, 1U);
  EXPECT_EQ(run->failed, 0U);
}

TEST_F(Units, KeepTheCacheWithinItsLimitButForTheirOwnWalks) {
  const TemporaryFolder cache;
  const fs::path old = cache.path() / "0123456789abcdef.walk";
  std::ofstream(old) << "of an earlier sweep";
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(1));
  const fs::path other = cache.path() / "fedcba9876543210.walk";
  std::ofstream(other) << "of another shard";
  UnitOptions small = options();
  small.cache = cache.path();
  small.cache_limit = 1;
  small.kept_walks = {"fedcba9876543210"};
  const auto scenario = shared(short_walk());
  const std::vector<SweepUnit> units = {unit_of(scenario, "leg", 1), unit_of(scenario, "leg", 2)};
  UnitRunner runner(small);
  const auto run = runner.run(units, keep_going);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->failed, 0U);
  EXPECT_EQ(run->walks, 2U);
  EXPECT_EQ(run->pruned.walks, 1U) << "those of the units are open";
  EXPECT_EQ(run->pruned.bytes, 19U);
  EXPECT_GT(run->pruned.left, 1U);
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(other));

  small.cache_limit = 0;
  std::ofstream(old) << "of an earlier sweep";
  small.units = folder_.path() / "again";
  ASSERT_TRUE(UnitRunner(small).run(units, keep_going));
  EXPECT_TRUE(fs::exists(old)) << "any size";
}

TEST_F(Units, EndWhenTheObserverHasEnough) {
  const auto scenario = shared(short_walk());
  std::vector<SweepUnit> units;
  for (const char* eta : {"2", "2.5"}) {  // both hang
    units.push_back(unit_of(scenario, std::string("aims+degeneracy.eta=") + eta));
  }
  const auto run =
      UnitRunner(options(), pretended).run(units, [](const UnitProgress&) { return false; });
  ASSERT_TRUE(run);
  EXPECT_FALSE(run->complete);
  EXPECT_EQ(run->done, 0U);
}

TEST_F(Units, AFolderThatCannotBeWrittenEndsTheWorkAndIsNamed) {
  UnitOptions blocked = options();
  std::ofstream(folder_.path() / "units") << "a file where the folder should be";
  const std::vector<SweepUnit> units = {unit_of(shared(short_walk()), "leg")};
  const auto run = UnitRunner(blocked).run(units, keep_going);
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().message.find((folder_.path() / "units").string()), std::string::npos);
}

}  // namespace
}  // namespace aims
