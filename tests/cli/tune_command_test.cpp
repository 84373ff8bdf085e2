// SPDX-License-Identifier: BSD-3-Clause
// `aims tune`, run as a user would, on a metre of a corridor.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/files/atomic_file.hpp"
#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;

/// The first one has no effect, and its range does not hold the default.
const std::string kPlan =
    "estimator: leg_inertial\n"
    "params: [\"queue.max_ahead=60:150\", \"initialization.sigma_gyro_bias=log(0.00001,0.1)\"]\n"
    "scenarios: [my.yaml]\n"
    "seeds: 1\n"
    "held_out: {seeds: 2}\n"
    "optimizer: {generations: 1, population: 5}\n";

class Tunes : public testing::CommandLine {
 protected:
  Tunes() {
    scenario(testing::kMetreWalk);
    write("plan.yaml", kPlan);
  }

  Outcome tune(const std::string& arguments) const {
    return aims("tune plan.yaml --cache walks --quiet --jobs 2 " + arguments);
  }

  /// The plan is refused with exit code 2 and one line that holds `expected`, and nothing is
  /// written.
  void expect_refused(const std::string& plan, const std::string& arguments,
                      const std::string& expected) const {
    write("plan.yaml", plan);
    const Outcome outcome = tune(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << plan << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_TRUE(holds(outcome, expected)) << outcome.output;
    EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  }

  static std::string with(std::string plan, const std::string& from, const std::string& to) {
    return plan.replace(plan.find(from), from.size(), to);
  }
};

TEST_F(Tunes, WriteValuesThatARunTakes) {
  const Outcome tuned = tune("--out out --apply tuned.yaml");
  ASSERT_EQ(tuned.exit_code, 0) << tuned.output;
  EXPECT_TRUE(holds(tuned, "held out")) << tuned.output;
  EXPECT_TRUE(holds(tuned, "diverged runs ")) << "what a user understands leads" << tuned.output;
  EXPECT_TRUE(holds(tuned, "\nobjective: ")) << tuned.output;
  EXPECT_TRUE(holds(tuned, "nothing can be concluded from one held-out seed")) << tuned.output;
  EXPECT_TRUE(holds(tuned, "note: the default 5 of queue.max_ahead lies outside of its range"))
      << tuned.output;
  EXPECT_FALSE(holds(tuned, "to use them: --set")) << tuned.output;
  EXPECT_TRUE(holds(tuned, "\nverdict: ")) << tuned.output;
  EXPECT_TRUE(holds(tuned, "search: ")) << tuned.output;
  EXPECT_LT(tuned.output.find("tuned values: queue.max_ahead "), tuned.output.find("tuned on"))
      << "it leads";
  for (const char* name : {"tune.md", "tune.csv", "tuned.yaml", "tune.yaml", "page.html"}) {
    EXPECT_TRUE(fs::exists(folder_.path() / "out" / name)) << name;
  }
  const std::string values = read_file(folder_.path() / "tuned.yaml").value();
  EXPECT_NE(values.find("      max_ahead: 5\n"), std::string::npos) << "the default " << values;
  const auto rate = values.find("      sigma_gyro_bias: ");
  ASSERT_NE(rate, std::string::npos) << values;
  const Outcome run =
      aims("run my.yaml --estimators leg_inertial --no-pictures --out run --set @tuned.yaml");
  EXPECT_EQ(run.exit_code, 0) << run.output;
  const std::string config = read_file(folder_.path() / "run" / "config.yaml").value();
  EXPECT_NE(config.find(values.substr(rate, values.find('\n', rate) - rate)), std::string::npos)
      << values << config;

  const Outcome again = tune("--out out");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_EQ(read_file(folder_.path() / "out" / "tuned.yaml").value(), values)
      << "nothing was done twice, and it says the same";
  EXPECT_FALSE(holds(again, "looked at")) << "the same sequences are one look";

  write("plan.yaml", with(kPlan, "held_out: {seeds: 2}", "held_out: {seeds: 2-3}"));
  const Outcome more = tune("--out out");
  EXPECT_TRUE(holds(more, "warning: held-out results were looked at 1 time before")) << more.output;
  const std::string report = read_file(folder_.path() / "out" / "tune.md").value();
  EXPECT_NE(report.find("- 1 sequences: my; seeds 2: nothing can be concluded"), std::string::npos)
      << report;
}

TEST_F(Tunes, RefuseBadPlansWithOneLine) {
  const auto over = [](const std::string& range) {
    return with(kPlan, "queue.max_ahead=60:150", range);
  };
  const std::string out = "--out out";
  expect_refused(over("queue.max_ahed=50:200"), out, "did you mean 'queue.max_ahead'");
  expect_refused(over("queue.max_ahead=200:50"), out, "reversed");
  expect_refused(over("queue.max_ahead=50:50"), out, "empty");
  expect_refused(over("queue.max_ahead=log(0,50)"), out, "logarithm");
  expect_refused(over("links.lidar.loss=0:0.5"), out, "would make the task easier");
  expect_refused(with(kPlan, "scenarios: [my.yaml]", "scenarios: []"), out,
                 "plan.yaml: no scenario is given");
  expect_refused(with(kPlan, "{seeds: 2}", "{seeds: 1}"), out, "also tuned on");
  expect_refused(kPlan + "generation: 3\n", out, "plan.yaml:7:1");
  expect_refused(kPlan, out + " --apply nowhere/tuned.yaml", "no folder");
  expect_refused(kPlan, out + " --cache-limit=-1", "not in range");
  expect_refused(kPlan, "--out my.yaml", "my.yaml: exists and is no folder of aims results");
}

TEST_F(Tunes, AreRefusedBesideAnother) {
  fs::create_directories(folder_.path() / "out");  // and nothing in it: the other begins
  const Outcome beside =
      shell("flock out/.lock '" AIMS_COMMAND "' tune plan.yaml --cache walks --quiet --out out");
  EXPECT_EQ(beside.exit_code, 2) << beside.output;
  EXPECT_TRUE(holds(beside, "out: in use by another aims command")) << beside.output;
}

}  // namespace
}  // namespace aims
