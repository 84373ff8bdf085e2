// SPDX-License-Identifier: BSD-3-Clause
// `aims sweep` and `aims merge`, run as a user would.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "io/atomic_file.hpp"
#include "tests/app/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

/// A metre of a corridor, thinly seen.
const std::string kWalk =
    "scene: {corridor: {length: 10}}\n"
    "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]}\n"
    "lidar: {columns: 200}\n";

const std::string kPlan =
    "scenarios: [my.yaml]\n"
    "seeds: 1\n"
    "estimators: [leg]\n"
    "over: [\"leg.rate_hz=100:200:3\"]\n";

class Sweeps : public testing::CommandLine {
 protected:
  Sweeps() {
    scenario(kWalk);
    std::ofstream(folder_.path() / "plan.yaml") << kPlan;
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

  static bool holds(const Outcome& outcome, const std::string& part) {
    return outcome.output.find(part) != std::string::npos;
  }
};

TEST_F(Sweeps, AreDoneOnceContinuedAndMerged) {
  const Outcome first = sweep("--out out --shard 1/3");
  ASSERT_EQ(first.exit_code, 0) << first.output;
  EXPECT_TRUE(holds(first, "1 units done, 0 of them failed; 0 found finished; 1 walks simulated"));
  const Outcome early = aims("merge out");
  EXPECT_EQ(early.exit_code, 1) << "units are missing";
  EXPECT_TRUE(holds(early, "1 of 3 units done")) << early.output;
  EXPECT_TRUE(holds(early, "missing: ")) << early.output;
  const Outcome rest = sweep("--out out");
  EXPECT_TRUE(holds(rest, "2 units done, 0 of them failed; 1 found finished; 0 walks simulated"))
      << rest.output;
  const Outcome merged = aims("merge out");
  EXPECT_EQ(merged.exit_code, 0) << merged.output;
  EXPECT_TRUE(holds(merged, "3 of 3 units done: out/sweep.sqlite")) << merged.output;
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "sweep.sqlite"));
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "sweep.csv"));
}

TEST_F(Sweeps, ListTheIdsThatTheirFilesWillHave) {
  const Outcome list = sweep("--list");
  ASSERT_EQ(list.exit_code, 0) << list.output;
  EXPECT_EQ(std::count(list.output.begin(), list.output.end(), '\n'), 3);
  EXPECT_TRUE(holds(list, "my seed 1 leg+leg.rate_hz=150")) << list.output;
  EXPECT_EQ(sweep("--list --shard 1/2").output + sweep("--list --shard 2/2").output, list.output);
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  ASSERT_EQ(sweep("--out out --shard 3/3").exit_code, 0);
  const std::string id =
      list.output.substr(list.output.rfind('\n', list.output.size() - 2) + 1, 16);
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "units" / (id + ".json"))) << id;
}

TEST_F(Sweeps, RecordUnitsThatTakeTooLongAndDoThemAgainWhenAsked) {
  const Outcome late = sweep("--estimators aims --timeout 0.001 --out out");
  EXPECT_EQ(late.exit_code, 1) << late.output;
  EXPECT_TRUE(holds(late, "3 units done, 3 of them failed")) << late.output;
  const Outcome why = aims("merge out");
  EXPECT_EQ(why.exit_code, 1);
  EXPECT_TRUE(holds(why, "timed_out: ")) << why.output;
  EXPECT_TRUE(holds(why, "stopped after 0.001 s")) << why.output;
  const Outcome kept = sweep("--estimators aims --timeout 0.001 --out out");
  EXPECT_TRUE(holds(kept, "0 units done")) << kept.output;
  const Outcome again = sweep("--estimators aims --timeout 0 --out out --retry");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_TRUE(holds(again, "3 units done, 0 of them failed")) << again.output;
}

TEST_F(Sweeps, RefuseBadPlansWithOneLine) {
  expect_refused("--over leg.rate_khz=1:2:2", {"unknown key 'leg.rate_khz'", "leg.rate_hz"});
  expect_refused("--over leg.rate_hz=2:1:2", {"leg.rate_hz=2:1:2", "reversed"});
  expect_refused("--over leg.rate_hz=5:5:3", {"empty"});
  expect_refused("--over 'leg.rate_hz=log(0,5,3)'", {"logarithm"});
  expect_refused("--over leg.rate_hz=-1:5:3", {"leg.rate_hz", "expected a number > 0"});
  expect_refused("--over leg.rate_hz=x", {"KEY=LOW:HIGH:COUNT"});
  expect_refused("--design sobbol", {"design", "sobol"});
  expect_refused("--samples 0", {"samples", ">= 1"});
  expect_refused("--shard 3/2", {"--shard", "'3/2'"});
  expect_refused("--scenarios nowhere", {"nowhere"});
  expect_refused("--estimators legs", {"did you mean 'leg'"});
  expect_refused("--out my.yaml", {"my.yaml", "no sweep's folder"});
  std::ofstream(folder_.path() / "plan.yaml") << "scenarios: []\n";
  expect_refused("", {"no scenario is given"});
  std::ofstream(folder_.path() / "plan.yaml") << kPlan << "desing: grid\n";
  expect_refused("", {"plan.yaml:5:1", "did you mean 'design'"});
  EXPECT_EQ(aims("merge nowhere").exit_code, 2);
}

TEST_F(Sweeps, AreRefusedBesideAnotherAndInAFolderOfAnotherPlan) {
  ASSERT_EQ(sweep("--out out --walks-only").exit_code, 0);
  expect_refused("--out out --seeds 1-2", {"out: holds units of another plan", "--renew"});
  const Outcome beside =
      shell("flock out/.lock '" AIMS_COMMAND "' sweep plan.yaml --cache walks --quiet --out out");
  EXPECT_EQ(beside.exit_code, 2) << beside.output;
  EXPECT_TRUE(holds(beside, "out: another sweep works there")) << beside.output;
}

TEST_F(Sweeps, SayWhichFileAFullDiskCouldNotTake) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  ASSERT_EQ(sweep("--out out --walks-only").exit_code, 0);
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
