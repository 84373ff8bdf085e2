// SPDX-License-Identifier: BSD-3-Clause
// Every command and shared option exists, under the same name and with the same help everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

using testing::Outcome;

/// Each command with the shared options that it has.
const std::map<std::string, std::vector<std::string>> kCommands = {
    {"run",
     {"--seeds", "--estimators", "--set", "--out", "--overwrite", "--cache", "--jobs", "--quiet"}},
    {"suite",
     {"--scenarios", "--tags", "--folder", "--seeds", "--estimators", "--set", "--out", "--cache",
      "--jobs", "--retry", "--quiet"}},
    {"sweep",
     {"--scenarios", "--tags", "--folder", "--seeds", "--estimators", "--param", "--set", "--out",
      "--cache", "--jobs", "--shard", "--retry", "--force", "--quiet"}},
    {"merge", {"--out"}},
    {"tune",
     {"--scenarios", "--tags", "--folder", "--seeds", "--estimators", "--param", "--set", "--out",
      "--cache", "--jobs", "--retry", "--quiet"}},
    {"study ablation",
     {"--scenarios", "--tags", "--folder", "--seeds", "--estimators", "--baselines", "--set",
      "--out", "--jobs", "--quiet"}},
    {"study sensitivity",
     {"--scenarios", "--tags", "--folder", "--seeds", "--estimators", "--factors", "--set", "--out",
      "--jobs", "--quiet"}},
    {"study consistency",
     {"--scenarios", "--tags", "--folder", "--seeds", "--estimators", "--set", "--out", "--jobs",
      "--quiet"}},
    {"study detectors",
     {"--scenarios", "--tags", "--folder", "--seeds", "--estimators", "--set", "--out", "--jobs",
      "--quiet"}},
    {"study compare", {"--out", "--json"}},
    {"study groups", {"--out", "--json"}},
    {"simulate", {"--seeds", "--set", "--out", "--overwrite", "--quiet"}},
    {"estimate", {"--estimators", "--set", "--out", "--overwrite", "--jobs", "--quiet"}},
    {"calibrate", {"--seeds", "--robot-seed", "--set", "--out", "--overwrite", "--quiet"}},
    {"score", {"--set", "--out", "--overwrite", "--waypoint-times", "--json", "--no-page"}},
    {"info", {"--set", "--config", "--recover", "--json"}},
    {"check", {"--set", "--config", "--recover", "--system", "--json"}},
    {"convert", {"--out", "--drop", "--overwrite", "--recover", "--quiet"}},
    {"render", {"--seeds", "--estimators", "--set", "--out", "--overwrite", "--jobs", "--quiet"}},
    {"page", {"--out", "--quiet"}},
    {"config", {"--folder", "--set", "--json"}},
    {"list", {"--folder", "--tags", "--json"}},
    {"completion", {}},
};

/// The options that `help` lists, "--quiet" and the like.
std::set<std::string> options_in(const std::string& help) {
  std::set<std::string> options;
  const std::regex line("\n  (-[^ ]+)");
  for (std::sregex_iterator i(help.begin(), help.end(), line), end; i != end; ++i) {
    const std::string names = (*i)[1];
    for (std::size_t begin = 0; begin < names.size();) {
      const std::size_t comma = std::min(names.find(',', begin), names.size());
      options.insert(names.substr(begin, comma - begin));
      begin = comma + 1;
    }
  }
  return options;
}

class Help : public testing::CommandLine {};

TEST_F(Help, ListsEveryCommandAndItsSharedOptions) {
  for (const auto& [command, options] : kCommands) {
    const Outcome help = aims(command + " --help");
    EXPECT_EQ(help.exit_code, 0) << command;
    const auto listed = options_in(help.output);
    for (const std::string& option : options) {
      EXPECT_TRUE(listed.contains(option)) << command << " " << option << "\n" << help.output;
    }
    const std::string parent = command.substr(0, command.find(' '));
    const bool below = parent != command;
    EXPECT_TRUE(holds(aims((below ? parent + " " : "") + "--help"),
                      "\n  " + command.substr(below ? parent.size() + 1 : 0) + " "))
        << command;
  }
}

TEST_F(Help, UnknownCommandsAndOptionsAreRefusedWithANearMatch) {
  const auto refused = [&](const std::string& arguments, const std::string& expected) {
    const Outcome outcome = aims(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    EXPECT_TRUE(holds(outcome, expected)) << outcome.output;
  };
  refused("suit", "unknown command 'suit'; did you mean 'aims suite'?");
  refused("compare a b", "did you mean 'aims study compare'?");
  refused("study ablations", "did you mean 'aims study ablation'?");
  refused("fly", "unknown command 'fly'; expected one of run, suite, sweep");
  refused("sweep --params a=1:2:3",
          "aims sweep: unknown option '--params'; did you mean '--param'?");
  refused("--seeds 1 run demo", "option '--seeds' stands before its command; give it after 'run'");
  refused("list corridor", "aims list: unexpected argument 'corridor'");
}

TEST_F(Help, OptionsWithoutEffectAreRefused) {
  const auto refused = [&](const std::string& arguments, const std::string& expected) {
    const Outcome outcome = aims(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
    EXPECT_TRUE(holds(outcome, expected)) << outcome.output;
  };
  scenario(testing::kMetreWalk);
  refused("simulate my.yaml --out x.bag --set estimators.aims.degeneracy.eta=3", "no effect");
  refused("info x.bag --set scoring.anchor=pose", "no effect");
  refused("sweep --scenarios my.yaml --param queue.max_ahead=1:2:2 --samples 9",
          "no effect on a grid");
  refused("sweep --scenarios my.yaml --design sobol", "no effect without --param");
  refused("render my.yaml --svg --fps 5", "no effect without --video");
  refused("render my.yaml --svg --view top", "no effect without --still or --video");
}

}  // namespace
}  // namespace aims
