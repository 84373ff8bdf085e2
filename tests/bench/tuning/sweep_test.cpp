// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_runner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>

#include "bench/jobs/job_store.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "bench/tuning/sweep_store.hpp"
#include "bench/tuning/tune_plan.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/sqlite_database.hpp"
#include "tests/bench/short_walk.hpp"
#include "tests/support/parameter_bounds.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::shared;
using testing::short_walk;

bool keep_going(const JobProgress&) { return true; }

SweepPlan small_plan() {
  SweepPlan plan;
  plan.scenarios = {AIMS_SCENARIOS "/paper/corridor.yaml", "severity_5"};
  plan.seeds = "1-3";
  plan.params = {"degeneracy.eta=0:6:4", "degeneracy.kappa=log(1,100,3)"};
  return plan;
}

Result<std::vector<Job>> jobs_of(const SweepPlan& plan) { return plan_jobs(plan, AIMS_SCENARIOS); }

std::string error_of(const SweepPlan& plan) {
  const auto jobs = jobs_of(plan);
  return jobs ? "no error" : jobs.error().message;
}

TEST(Plans, EveryNumberHasTwoFiniteBounds) {
  SweepPlan sweep;
  testing::expect_bounded(fields_of(sweep));
  TunePlan tune;
  tune.objectives.resize(1);
  testing::expect_bounded(fields_of(tune));
}

TEST(SweepPlan, MakesEveryPointOnEveryWalkAndThoseOnOneWalkStandTogether) {
  const auto jobs = jobs_of(small_plan());
  ASSERT_TRUE(jobs) << jobs.error().message;
  ASSERT_EQ(jobs->size(), 2U * 3U * 13U);
  std::set<std::string> ids;
  std::set<std::pair<std::string, std::uint64_t>> sequences;
  for (std::size_t i = 0; i < jobs->size(); ++i) {
    const Job& job = (*jobs)[i];
    EXPECT_EQ(job.id, make_job(job.scenario, job.seed, job.estimator).id);
    ids.insert(job.id);
    const auto sequence = std::pair(job.scenario->name, job.seed);
    EXPECT_EQ(sequences.insert(sequence).second, i % 13 == 0);
  }
  EXPECT_EQ(ids.size(), jobs->size());
}

TEST(SweepPlan, ReadsBackFromItsText) {
  const TemporaryFolder folder;
  SweepPlan plan = small_plan();
  plan.design = DesignKind::kSobol;
  plan.samples = 7;
  plan.timeout = 12.5;
  const fs::path file = folder.path() / "plan.yaml";
  std::ofstream(file) << plan_text(plan);
  const auto read = load_plan(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(plan_text(*read), plan_text(plan));
  EXPECT_EQ(jobs_of(*read)->size(), 2U * 3U * 8U);
}

TEST(SweepPlan, RefusesWhatIsNotRight) {
  const auto with = [](auto change) {
    SweepPlan plan = small_plan();
    change(plan);
    return error_of(plan);
  };
  const auto expect = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect(with([](auto& p) { p.scenarios.clear(); }), "no scenario is given");
  expect(with([](auto& p) { p.scenarios = {"coridor"}; }), "did you mean 'corridor'");
  expect(with([](auto& p) { p.tags = {"dail"}; }), "no scenario has the tag 'dail'");
  expect(with([](auto& p) { p.params = {"degeneracy.etta=0:1:2"}; }), "degeneracy.eta");
  expect(with([](auto& p) { p.params = {"degeneracy.eta=6:0:2"}; }), "reversed");
  expect(with([](auto& p) { p.params = {"degeneracy.eta=1:1:3"}; }), "empty");
  expect(with([](auto& p) { p.params = {"degeneracy.kappa=log(0,1,3)"}; }), "logarithm");
  expect(with([](auto& p) { p.params = {"degeneracy.alpha=0:7:3"}; }), "a number in [0, 1)");
  expect(with([](auto& p) { p.estimators = {"aimz"}; }), "did you mean 'aims'");
  expect(with([](auto& p) { p.estimators.clear(); }), "estimators");
  expect(with([](auto& p) { p.seeds = ""; }), "is not a seed");
  expect(with([](auto& p) { p.set = {"scene.corridor.lenght=3"}; }), "scene.corridor.length");
}

TEST(SweepPlan, HoldsNoUnitTwiceWhenPointsRoundToOne) {
  SweepPlan plan = small_plan();
  plan.scenarios = {"corridor"};
  plan.seeds = "1";
  plan.params = {"lidar.max_iterations=1:3:9"};
  EXPECT_EQ(jobs_of(plan)->size(), 4U) << "with the default of 4";
}

/// A sweep of two settings of the cheapest estimator over a short sequence, and its sequence.
class Sweep : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    sequences_ = new TemporaryFolder;
    ASSERT_TRUE(SequenceCache(sequences_->path()).make(short_walk(), 1));
  }
  static void TearDownTestSuite() { delete sequences_; }

  Sweep() {
    plan_.scenarios = {"short"};
    const auto scenario = shared(short_walk());
    for (const char* spec : {"leg+queue.max_ahead=100", "leg+queue.max_ahead=200"}) {
      jobs_.push_back(make_job(scenario, 1, parse_estimator_spec(spec).value()));
    }
    options_.out = folder_.path() / "sweep";
    options_.cache = sequences_->path();
  }

  Result<JobRun> sweep() {
    return run_jobs({.jobs = jobs_, .shard = shard_, .plan = plan_text(plan_), .force = force_},
                    options_, keep_going);
  }

  void expect_refused(const std::string& part) {
    const auto run = sweep();
    ASSERT_FALSE(run);
    EXPECT_NE(run.error().message.find(part), std::string::npos) << run.error().message;
    EXPECT_NE(run.error().message.find(options_.out.string()), std::string::npos);
  }

  static TemporaryFolder* sequences_;
  TemporaryFolder folder_;
  SweepPlan plan_;
  std::vector<Job> jobs_;
  JobOptions options_;
  Shard shard_;
  bool force_ = false;
};

TemporaryFolder* Sweep::sequences_ = nullptr;

TEST_F(Sweep, FillsItsFolderShardByShardAndContinues) {
  shard_ = {2, 2};
  const auto second = sweep();
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->done, 1U);
  const auto half = merge_sweeps(std::vector{options_.out});
  ASSERT_TRUE(half);
  EXPECT_EQ(half->jobs[0].outcome(), "missing");
  EXPECT_EQ(half->jobs[1].outcome(), "done");
  shard_ = {};
  const auto rest = sweep();
  ASSERT_TRUE(rest) << rest.error().message;
  EXPECT_EQ(rest->done, 1U);
  EXPECT_EQ(rest->reused, 1U);
}

TEST_F(Sweep, KeepsToOnePlanCodeAndScenarios) {
  ASSERT_TRUE(sweep());
  const fs::path file = options_.out / "plan.yaml";
  const std::string text = read_file(file).value();
  std::string other = text;
  other.replace(other.find("# code ") + 7, 4, "beef");
  ASSERT_TRUE(write_file_atomically(file, other));
  expect_refused("holds jobs of code beef");
  ASSERT_TRUE(write_file_atomically(file, text));

  plan_.timeout = 60.0;
  EXPECT_TRUE(sweep()) << "it decides no result";
  jobs_.pop_back();
  plan_.samples = 5;
  expect_refused("holds jobs of another plan, with 'samples: 64'");
  plan_.samples = 64;
  expect_refused("other scenarios");
  force_ = true;
  const auto renewed = sweep();
  ASSERT_TRUE(renewed) << renewed.error().message;
  EXPECT_EQ(renewed->reused, 1U);
  const auto merged = merge_sweeps(std::vector{options_.out});
  ASSERT_TRUE(merged);
  EXPECT_EQ(merged->jobs.size(), 1U);
  EXPECT_EQ(merged->others, 1U) << "the job that is listed no more";
}

TEST_F(Sweep, MergesFoldersIntoOneDatabaseAndTable) {
  shard_ = {1, 2};
  ASSERT_TRUE(sweep());
  const fs::path first = options_.out;
  options_.out = folder_.path() / "elsewhere";
  shard_ = {2, 2};
  ASSERT_TRUE(sweep());
  const auto merged = merge_sweeps(std::vector{first, options_.out});
  ASSERT_TRUE(merged) << merged.error().message;
  EXPECT_EQ(merged->count("done"), 2U);
  EXPECT_EQ(merged->plans.size(), 1U);

  const fs::path file = folder_.path() / "sweep.sqlite";
  ASSERT_TRUE(write_sqlite(*merged, file));
  ASSERT_TRUE(write_sqlite(*merged, file)) << "over an earlier one";
  const auto database = SqliteDatabase::open(file, 1000);
  ASSERT_TRUE(database);
  auto query = database->prepare(
      "SELECT CAST(p.value AS INTEGER), printf('%!.17g', s.value), u.seed FROM jobs u "
      "JOIN parameters p USING (job) JOIN scores s USING (job) WHERE p.key = 'queue.max_ahead' "
      "AND s.key = 'm_end_m' AND u.outcome = 'done' ORDER BY p.value");
  ASSERT_TRUE(query) << query.error().message;
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(query->step().value());
    EXPECT_EQ(query->integer(0), i == 0 ? 100 : 200);
    const JobStore folder(i == 0 ? first : options_.out);
    EXPECT_EQ(std::stod(query->text(1)), score_in(*folder.find(jobs_[i].id), "m_end_m"));
    EXPECT_EQ(query->integer(2), 1);
  }
  EXPECT_FALSE(query->step().value());

  const fs::path csv = folder_.path() / "sweep.csv";
  ASSERT_TRUE(write_sweep_csv(*merged, csv));
  const std::string text = read_file(csv).value();
  EXPECT_NE(text.find("id,scenario,seed,estimator,outcome,queue.max_ahead,success"),
            std::string::npos);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
}

TEST_F(Sweep, OfAnotherPlanIsNotMerged) {
  const auto folder_of = [&](const char* name, const std::string& plan) {
    const fs::path folder = folder_.path() / name;
    fs::create_directories(folder);
    EXPECT_TRUE(JobStore(folder).enter(jobs_, plan, false));
    return folder;
  };
  const std::string base = "scenarios: [corridor]\n";
  const fs::path a = folder_of("a", base + "params: [\"degeneracy.eta=0:6:3\"]\n");
  const fs::path b = folder_of("b", base + "params: [\"degeneracy.kappa=1:9:3\"]\n");
  const fs::path c = folder_of("c", base + "params: [\"degeneracy.eta=0:6:3\"]\nseeds: 6-9\n");
  const auto refused = merge_sweeps(std::vector{a, b});
  ASSERT_FALSE(refused);
  const std::string& why = refused.error().message;
  for (const std::string& part :
       {(a / "plan.yaml").string() + " and " + (b / "plan.yaml").string(),
        std::string("params: [degeneracy.eta=0:6:3] and [degeneracy.kappa=1:9:3]"),
        std::string("nothing was written")}) {
    EXPECT_NE(why.find(part), std::string::npos) << part << " in: " << why;
  }
  EXPECT_TRUE(merge_sweeps(std::vector{a, c})) << "more seeds";
  EXPECT_FALSE(merge_sweeps(std::vector{b, c}));
}

TEST_F(Sweep, OfAnotherVersionOfAScenarioOrAClassIsNotMerged) {
  const auto folder_of = [&](const char* name, const char* seeds, const char* version) {
    const fs::path folder = folder_.path() / name;
    fs::create_directories(folder);
    std::vector<Job> jobs = jobs_;
    for (Job& job : jobs) {
      job.id += version + std::string(seeds);
      job.version = version;
    }
    const std::string plan = "params: [\"degeneracy.eta=0:6:3\"]\nseeds: " + std::string(seeds);
    EXPECT_TRUE(JobStore(folder).enter(jobs, plan + "\n", false));
    return folder;
  };
  const fs::path a = folder_of("a", "1-2", "v1");
  const fs::path b = folder_of("b", "3-4", "v1");
  const fs::path c = folder_of("c", "3-4", "v2");
  EXPECT_TRUE(merge_sweeps(std::vector{a, b}));
  const auto refused = merge_sweeps(std::vector{a, c});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find(a.string() + " and " + c.string() + " have two versions"),
            std::string::npos)
      << refused.error().message;
}

TEST_F(Sweep, TheObjectiveOfTheLastMergeIsKeptForThePage) {
  EXPECT_EQ(objective_in(folder_.path())->score, Objective{}.score);
  Objective objective;
  objective.score = "m_list_percent.all";
  objective.divergence_penalty = 0.0;
  ASSERT_TRUE(write_objective(objective, folder_.path()));
  const auto kept = objective_in(folder_.path());
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(text_of(*kept), text_of(objective));
}

TEST_F(Sweep, ADatabaseThatCannotBeWrittenIsNamed) {
  const fs::path file = folder_.path() / "nowhere" / "sweep.sqlite";
  const auto written = write_sqlite({}, file);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find(file.string() + ": cannot be written"), std::string::npos);
  const auto merged = merge_sweeps(std::vector{folder_.path()});
  ASSERT_FALSE(merged);
  EXPECT_NE(merged.error().message.find("holds no results: no jobs.csv"), std::string::npos);
}

}  // namespace
}  // namespace aims
