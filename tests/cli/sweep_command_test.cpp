// SPDX-License-Identifier: BSD-3-Clause
// `aims sweep` and `aims merge`, run as a user would.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "core/files/atomic_file.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

const std::string kPlan =
    "scenarios: [my.yaml]\n"
    "seeds: 1\n"
    "estimators: [leg]\n"
    "params: [\"queue.max_ahead=100:200:3\"]\n";

class Sweeps : public testing::CommandLine {
 protected:
  Sweeps() {
    scenario(testing::kMetreWalk);
    write("plan.yaml", kPlan);
  }

  Outcome sweep(const std::string& arguments) const {
    return aims("sweep plan.yaml --cache walks --quiet --jobs 2 " + arguments);
  }

  /// Refused with exit code 2 and one line that holds all of `expected`.
  void expect_refused(const std::string& arguments,
                      std::initializer_list<std::string> expected) const {
    const Outcome outcome = sweep(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    for (const std::string& each : expected) {
      EXPECT_NE(outcome.output.find(each), std::string::npos) << each << "\n" << outcome.output;
    }
  }
};

TEST_F(Sweeps, AreDoneOnceContinuedAndMerged) {
  const Outcome first = sweep("--out out --shard 1/4");
  ASSERT_EQ(first.exit_code, 0) << first.output;
  EXPECT_TRUE(
      holds(first, "1 jobs done, 0 of them failed; 0 found finished; 1 sequences simulated"));
  const Outcome early = aims("merge out");
  EXPECT_EQ(early.exit_code, 1) << "jobs are missing";
  EXPECT_TRUE(holds(early, "1 of 4 jobs done")) << early.output;
  EXPECT_TRUE(holds(early, "missing: ")) << early.output;
  const Outcome rest = sweep("--out out");
  EXPECT_TRUE(holds(rest, "3 jobs done, 0 of them failed; 1 found finished; 0 sequences simulated"))
      << rest.output;
  EXPECT_TRUE(holds(rest, "results: out/sweep.md, sweep.csv, sweep.sqlite")) << rest.output;
  EXPECT_FALSE(holds(rest, "aims merge")) << rest.output;
  for (const char* name : {"sweep.md", "sweep.csv", "sweep.sqlite", "page.html"}) {
    EXPECT_TRUE(fs::exists(folder_.path() / "out" / name)) << name;
  }
  const Outcome misspelt = aims("merge out --score ate_yaw");
  EXPECT_EQ(misspelt.exit_code, 2) << misspelt.output;
  EXPECT_TRUE(holds(misspelt, "no job has a score 'ate_yaw'")) << misspelt.output;
  const Outcome merged = aims("merge out");
  EXPECT_EQ(merged.exit_code, 0) << merged.output;
  EXPECT_TRUE(holds(merged, "4 of 4 jobs done: out/sweep.sqlite")) << merged.output;
  for (const Outcome& each : {rest, merged}) {
    EXPECT_TRUE(std::regex_search(
        each.output,
        std::regex("estimator +queue.max_ahead +objective +score \\(ate_yaw_m\\), median")))
        << each.output;
    EXPECT_TRUE(std::regex_search(each.output, std::regex("\nleg \\(default\\) +5 ")));
    for (const char* point : {"100", "150", "200"}) {
      EXPECT_TRUE(std::regex_search(each.output,
                                    std::regex(std::string("\nleg +") + point + " .* 0 of 1\n")))
          << point << "\n"
          << each.output;
    }
  }
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "sweep.sqlite"));
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "sweep.csv"));
}

TEST_F(Sweeps, MergedIntoAFolderOfItsOwnHaveAPageAndSayWhatWasDoneTwice) {
  ASSERT_EQ(sweep("--out first --shard 1/2").exit_code, 0);
  ASSERT_EQ(sweep("--out second --shard 2/2").exit_code, 0);
  const Outcome shards = aims("merge first second --out all");
  EXPECT_EQ(shards.exit_code, 0) << shards.output;
  EXPECT_TRUE(holds(shards, "4 of 4 jobs done: all/sweep.sqlite")) << shards.output;
  EXPECT_FALSE(holds(shards, "note: ")) << shards.output;
  EXPECT_TRUE(holds(shards, "page: all/page.html")) << shards.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "all" / "page.html"));
  // One job of the first shard fails on another machine.
  fs::copy(folder_.path() / "first", folder_.path() / "failed", fs::copy_options::recursive);
  const fs::path job = fs::directory_iterator(folder_.path() / "failed" / "jobs")->path();
  nlohmann::json json = nlohmann::json::parse(*read_file(job));
  json["outcome"] = "failed";
  json["message"] = "no such file";
  std::ofstream(job) << json.dump();
  const Outcome twice = aims("merge failed first second --out twice");
  EXPECT_EQ(twice.exit_code, 0) << twice.output;
  EXPECT_TRUE(holds(twice, "note: 1 job failed in one folder and is done in another, which counts"))
      << twice.output;
}

TEST_F(Sweeps, ListTheIdsThatTheirFilesWillHave) {
  const Outcome list = sweep("--list");
  ASSERT_EQ(list.exit_code, 0) << list.output;
  EXPECT_EQ(std::count(list.output.begin(), list.output.end(), '\n'), 4) << "the defaults are one";
  EXPECT_TRUE(holds(list, "my seed 1 leg+queue.max_ahead=150")) << list.output;
  EXPECT_EQ(sweep("--list --shard 1/2").output + sweep("--list --shard 2/2").output, list.output);
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  ASSERT_EQ(sweep("--out out --shard 3/3").exit_code, 0);
  const std::string id =
      list.output.substr(list.output.rfind('\n', list.output.size() - 2) + 1, 16);
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "jobs" / (id + ".json"))) << id;
}

TEST_F(Sweeps, RecordJobsThatTakeTooLongAndDoThemAgainWhenAsked) {
  const Outcome late = sweep("--estimators aims --timeout 0.001 --out out");
  EXPECT_EQ(late.exit_code, 1) << late.output;
  EXPECT_TRUE(holds(late, "4 jobs done, 4 of them failed")) << late.output;
  const Outcome why = aims("merge out");
  EXPECT_EQ(why.exit_code, 1);
  EXPECT_TRUE(holds(why, "timed_out: ")) << why.output;
  EXPECT_TRUE(holds(why, "stopped after 0.001 s")) << why.output;
  const Outcome kept = sweep("--estimators aims --timeout 0.001 --out out");
  EXPECT_TRUE(holds(kept, "0 jobs done")) << kept.output;
  const Outcome again = sweep("--estimators aims --timeout 0 --out out --retry");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_TRUE(holds(again, "4 jobs done, 0 of them failed")) << again.output;
}

TEST_F(Sweeps, RefuseBadPlansWithOneLine) {
  expect_refused("--param queue.max_ahed=1:2:2",
                 {"unknown key 'queue.max_ahed'", "queue.max_ahead"});
  expect_refused("--param queue.max_ahead=2:1:2", {"queue.max_ahead=2:1:2", "reversed"});
  expect_refused("--param queue.max_ahead=5:5:3", {"empty"});
  expect_refused("--param 'queue.max_ahead=log(0,5,3)'", {"logarithm"});
  expect_refused("--param queue.max_ahead=-1:5:3",
                 {"queue.max_ahead", "expected a number in [1e-12, 1e+06]"});
  expect_refused("--param queue.max_ahead=x", {"KEY=LOW:HIGH:COUNT"});
  expect_refused("--param links.leg_odometry.los=0:1:2",
                 {"did you mean 'links.leg_odometry.loss'"});
  expect_refused("--param links.leg_odometry.loss=0:2:3",
                 {"links.leg_odometry.loss=0:2:3", "a number in [0, 1]"});
  expect_refused("--param imu.gyro_bias_walk=0:1:3",
                 {"expected 'estimators.*.imu.gyro_bias_walk'"});
  expect_refused("--param seed=1:5:5", {"'seeds'"});
  expect_refused("--cache-limit=-1", {"--cache-limit", "not in range"});
  expect_refused("--design sobbol", {"design", "sobol"});
  expect_refused("--samples 0", {"--samples", "not in range"});
  expect_refused("--shard 3/2", {"--shard", "'3/2'"});
  expect_refused("--scenarios nowhere", {"nowhere"});
  expect_refused("--estimators legs", {"did you mean 'leg'"});
  expect_refused("--out my.yaml", {"my.yaml", "no folder of aims results"});
  write("plan.yaml", "scenarios: []\n");
  expect_refused("", {"no scenario is given"});
  write("plan.yaml", kPlan + "desing: grid\n");
  expect_refused("", {"plan.yaml:5:1", "did you mean 'design'"});
  EXPECT_EQ(aims("merge nowhere").exit_code, 2);
}

TEST_F(Sweeps, AreRefusedBesideAnotherAndInAFolderOfAnotherPlan) {
  ASSERT_EQ(sweep("--out out --simulate-only").exit_code, 0);
  expect_refused("--out out --seeds 1-2", {"out: holds jobs of another plan", "--force"});
  const Outcome beside =
      shell("flock out/.lock '" AIMS_COMMAND "' sweep plan.yaml --cache walks --quiet --out out");
  EXPECT_EQ(beside.exit_code, 2) << beside.output;
  EXPECT_TRUE(holds(beside, "out: in use by another aims command")) << beside.output;
}

TEST_F(Sweeps, OverTheSimulationMakeASequencePerValue) {
  const Outcome done =
      sweep("--out out --param links.leg_odometry.loss=0:0.9:3 --param queue.max_ahead=100:200:2");
  ASSERT_EQ(done.exit_code, 0) << done.output;
  EXPECT_TRUE(holds(done, "7 jobs done, 0 of them failed; 0 found finished; 4 sequences simulated"))
      << done.output;
  ASSERT_EQ(aims("merge out").exit_code, 0);
  const auto table = read_file(folder_.path() / "out" / "sweep.csv");
  ASSERT_TRUE(table);
  EXPECT_NE(table->find("links.leg_odometry.loss"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "sweep.md"));
  const Outcome other = sweep("--out other --param scoring.max_error_offset=1:2:3");
  EXPECT_TRUE(
      holds(other, "4 jobs done, 0 of them failed; 0 found finished; 0 sequences simulated"))
      << "the defaults have the sequence already" << other.output;
}

TEST_F(Sweeps, KeepWhatIsFinishedAtCtrlCAndContinue) {
  ASSERT_EQ(sweep("--out out --param queue.max_ahead=100:200:101 --simulate-only").exit_code, 0);
  const std::string command =
      "sweep plan.yaml --cache walks --quiet --jobs 1 --out out "
      "--param queue.max_ahead=100:200:101";
  const Outcome ended = shell(
      "{ '" AIMS_COMMAND "' " + command +
      " & pid=$!; until ls out/jobs/*.json >first 2>&1 || ! kill -0 $pid; do sleep 0.01; done; "
      "kill -INT $pid; wait $pid; }");
  EXPECT_EQ(ended.exit_code, 130) << ended.output;
  EXPECT_TRUE(holds(ended, "interrupted: the same command continues")) << ended.output;
  std::size_t finished = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "out" / "jobs")) {
    if (entry.path().extension() == ".json") ++finished;
  }
  EXPECT_GE(finished, 1U);
  ASSERT_LT(finished, 102U) << "Ctrl-C came too late to tell";
  const Outcome rest = aims(command);
  EXPECT_EQ(rest.exit_code, 0) << rest.output;
  EXPECT_TRUE(holds(rest, std::to_string(102 - finished) + " jobs done, 0 of them failed; " +
                              std::to_string(finished) + " found finished; 0 sequences"))
      << rest.output;
}

TEST_F(Sweeps, SayWhatIsRemovedFromTheCache) {
  fs::create_directories(folder_.path() / "walks");
  const fs::path old = folder_.path() / "walks" / "0123456789abcdef.sequence";
  std::ofstream(old) << std::string(5'000'000, 'w');
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(1));
  EXPECT_FALSE(holds(sweep("--out out"), "removed")) << "20 GB may stay";
  EXPECT_TRUE(fs::exists(old));
  const Outcome outcome = sweep("--out out --retry --cache-limit 0.001");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_TRUE(holds(outcome, "walks: ")) << outcome.output;
  EXPECT_TRUE(holds(outcome, " GB (--cache-limit 0.001)")) << outcome.output;
  EXPECT_FALSE(fs::exists(old));
}

TEST_F(Sweeps, AreRefusedInAFolderOfAnotherCode) {
  ASSERT_EQ(sweep("--out out").exit_code, 0);
  const fs::path file = folder_.path() / "out" / "plan.yaml";
  std::string text = read_file(file).value();
  text.replace(text.find("# code ") + 7, 4, "beef");
  std::ofstream(file) << text;
  expect_refused("--out out", {"out: holds jobs of code beef", "this is code", "--force"});
  const Outcome renewed = sweep("--out out --force");
  EXPECT_EQ(renewed.exit_code, 0) << renewed.output;
  EXPECT_TRUE(holds(renewed, "4 found finished")) << "their ids say which code they are of";
}

TEST_F(Sweeps, EndWithTheFileThatNoSpaceIsLeftFor) {
  fs::create_directories(folder_.path() / "small");
  if (shell("unshare -rm mount -t tmpfs -o size=48k tmpfs small").exit_code != 0) {
    GTEST_SKIP() << "no disk of a few kilobytes can be mounted here";
  }
  const Outcome full = shell(
      "unshare -rm sh -c 'mount -t tmpfs -o size=48k tmpfs small && \"$0\" sweep plan.yaml "
      "--cache walks --quiet --param queue.max_ahead=100:200:40 --out small/out; code=$?; "
      "find small -name \"*.tmp\"; exit $code' '" AIMS_COMMAND "'");
  EXPECT_EQ(full.exit_code, 2) << full.output;
  EXPECT_TRUE(holds(full, "small/out/jobs/")) << full.output;
  EXPECT_TRUE(holds(full, "No space left on device")) << full.output;
  EXPECT_FALSE(holds(full, ".tmp")) << "nothing half-written remains: " << full.output;
}

TEST_F(Sweeps, SayWhichFileAFullDiskCouldNotTake) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  ASSERT_EQ(sweep("--out out --simulate-only").exit_code, 0);
  // A limit on the size of files stands in for a disk that is full: no walk fits.
  const Outcome full = shell("ulimit -f 64; trap '' XFSZ; '" AIMS_COMMAND
                             "' sweep plan.yaml --cache others --quiet --out out");
  EXPECT_EQ(full.exit_code, 2) << full.output;
  EXPECT_TRUE(holds(full, "others/")) << full.output;
  EXPECT_TRUE(holds(full, "cannot be written: File too large")) << full.output;
  EXPECT_EQ(sweep("--out out").exit_code, 0) << "nothing is left that would be in the way";
}

}  // namespace
}  // namespace aims
