// SPDX-License-Identifier: BSD-3-Clause
// A real SIGTERM to a real process, as schedulers and containers send it.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "bench/scoring/score_record.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/tum.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

/// Takes so long that a signal always comes before its end.
const std::string kLongWalk =
    "scene: {corridor: {length: 200}}\n"
    "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 180, y: 0}]}\n"
    "lidar: {columns: 200}\n";

class Signals : public testing::CommandLine {
 protected:
  void SetUp() override { write("long.yaml", kLongWalk); }

  /// Runs the command and sends it `signal` once `condition`, a shell command, holds.
  Outcome ended(const std::string& command, const std::string& condition,
                const char* signal = "TERM") const {
    return shell("{ '" AIMS_COMMAND "' " + command + " & pid=$!; until " + condition +
                 " >first 2>&1 || ! kill -0 $pid 2>first; do sleep 0.01; done; kill -" + signal +
                 " $pid; wait $pid; }");
  }

  bool has_remains() const {
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      if (name.find(".partial") != std::string::npos) return true;
    }
    return false;
  }
};

TEST_F(Signals, TermEndsASimulationWithABagThatCanBeEstimated) {
  const Outcome simulated =
      ended("simulate long.yaml --out walk.bag", "[ $(cat walk* | wc -c) -gt 1000000 ]");
  EXPECT_EQ(simulated.exit_code, 143) << simulated.output;
  EXPECT_TRUE(holds(simulated, "interrupted: the bag ends where")) << simulated.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "walk.truth.tum"));
  const Outcome estimated = aims("estimate walk.bag --estimators leg --out est --no-pictures");
  EXPECT_EQ(estimated.exit_code, 0) << estimated.output;
}

TEST_F(Signals, TermEndsAnEstimateWithWhatWasRead) {
  ended("simulate long.yaml --out walk.bag", "[ $(cat walk* | wc -c) -gt 20000000 ]");
  const Outcome estimate =
      ended("estimate walk.bag --estimators aims,tfs,lio --jobs 1 --no-pictures --out est",
            "ls -d est.partial");
  EXPECT_EQ(estimate.exit_code, 143) << estimate.output;
  EXPECT_TRUE(holds(estimate, "interrupted: the results end where")) << estimate.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "est" / "estimate.json"));
  EXPECT_FALSE(has_remains());
}

TEST_F(Signals, KillLeavesTheRowsOfAnEstimateSoFar) {
  ended("simulate long.yaml --out walk.bag", "[ $(cat walk* | wc -c) -gt 20000000 ]");
  const Outcome estimate = ended("estimate walk.bag --estimators aims,leg --jobs 1 --out est",
                                 "[ $(cat est.partial/aims.tum* | wc -c) -gt 2000 ]", "KILL");
  EXPECT_EQ(estimate.exit_code, 137) << estimate.output;
  std::vector<std::string> readable;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "est.partial")) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("aims.tum")) continue;
    const auto poses = read_tum(entry.path());
    ASSERT_TRUE(poses) << poses.error().message;
    EXPECT_GT(poses->size(), 15U);
    readable.push_back(name);
  }
  EXPECT_EQ(readable.size(), 1U);
}

TEST_F(Signals, TermEndsSuitesAndSweepsWithWhatIsFinished) {
  write("short.yaml", testing::kMetreWalk);
  const Outcome suite =
      ended("suite short.yaml long.yaml --estimators leg --jobs 1 --no-page --out suite",
            "ls suite/jobs/*.json");
  EXPECT_EQ(suite.exit_code, 143) << suite.output;
  EXPECT_TRUE(holds(suite, "interrupted: the same command continues")) << suite.output;
  const auto json = read_file(folder_.path() / "suite" / "suite.json");
  ASSERT_TRUE(json);
  EXPECT_FALSE(Json::parse(*json)["complete"].get<bool>());
  const Outcome sweep =
      ended("sweep --scenarios short.yaml,long.yaml --estimators leg --jobs 1 --out sweep",
            "ls sweep/jobs/*.json");
  EXPECT_EQ(sweep.exit_code, 143) << sweep.output;
  EXPECT_FALSE(has_remains());
}

TEST_F(Signals, TermEndsARunBeforeItsFirstResult) {
  const Outcome run =
      ended("run long.yaml --estimators leg --no-pictures --no-page --out run", "ls run/jobs.csv");
  EXPECT_EQ(run.exit_code, 143) << run.output;
  EXPECT_FALSE(has_remains());
}

TEST_F(Signals, TermEndsATuning) {
  write("plan.yaml", "scenarios: [long.yaml]\nseeds: '1'\nparams: [\"degeneracy.eta=1:2\"]\n");
  const Outcome tune = ended("tune plan.yaml --out tune", "ls tune/tune.yaml");
  EXPECT_EQ(tune.exit_code, 143) << tune.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "tune" / "tune.md"));
}

}  // namespace
}  // namespace aims
