// SPDX-License-Identifier: BSD-3-Clause
// What shells complete, asked of the shells themselves.
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

using testing::Outcome;
using Words = std::set<std::string>;

class Completion : public testing::CommandLine {
 protected:
  /// What bash proposes for the last of these words: "aims run ''".
  Words in_bash(const std::string& words) const {
    const Outcome outcome =
        shell("bash -c 'source <(" AIMS_COMMAND " completion bash); COMP_WORDS=(" + words +
              "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _aims " AIMS_COMMAND
              "; printf \"%s\\n\" \"${COMPREPLY[@]}\"'");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    std::istringstream lines(outcome.output);
    Words proposed;
    for (std::string line; std::getline(lines, line);) {
      if (!line.empty()) proposed.insert(line);
    }
    return proposed;
  }
};

TEST_F(Completion, OfCommands) {
  EXPECT_EQ(in_bash("aims su"), Words({"suite"}));
  EXPECT_EQ(in_bash("aims study c"), Words({"compare", "consistency"}));
  const Words all = in_bash("aims \"\"");
  for (const char* command : {"run", "tune", "completion"}) EXPECT_TRUE(all.contains(command));
  EXPECT_FALSE(all.contains("ablation")) << "a command of study";
}

TEST_F(Completion, OfOptionsAndTheirValues) {
  EXPECT_EQ(in_bash("aims run --no-p"), Words({"--no-pictures", "--no-page"}));
  EXPECT_EQ(in_bash("aims study compare --fail"), Words({"--fail-on-worse"}));
  EXPECT_EQ(in_bash("aims simulate --compression \"\""), Words({"none", "lz4", "bz2", "zstd"}));
  EXPECT_EQ(in_bash("aims simulate --compression = b"), Words({"bz2"}));
  EXPECT_TRUE(in_bash("aims run --out \"\"").empty()) << "any text";
}

TEST_F(Completion, OfKeys) {
  EXPECT_EQ(in_bash("aims run --set lidar.range_mi"), Words({"lidar.range_min="}));
  EXPECT_TRUE(in_bash("aims suite --set lidar.ra").contains("lidar.range_max="));
  EXPECT_TRUE(
      in_bash("aims run --set estimators.lio.").contains("estimators.lio.lidar.enabled="));
  EXPECT_TRUE(in_bash("aims estimate --set lidar.ra").empty()) << "no key of a recording";
}

TEST_F(Completion, OfNamesOfScenariosAndEstimators) {
  const std::string folder = std::string("cd '" AIMS_SOURCE_DIR "'; ");
  const Outcome names = shell(folder + AIMS_COMMAND " completion scenarios");
  EXPECT_TRUE(holds(names, "\ncorridor_smooth\n")) << names.output;
  write("own.yaml", testing::kMetreWalk);
  EXPECT_TRUE(shell("mkdir scenarios && cp own.yaml scenarios/").output.empty());
  EXPECT_EQ(in_bash("aims run o"), Words({"own"})) << "after a command";
  EXPECT_EQ(in_bash("aims run --quiet o"), Words({"own"})) << "after an option without a value";
  EXPECT_EQ(in_bash("aims suite --scenarios own,o"), Words({"own,own"})) << "in a list";
  EXPECT_EQ(in_bash("aims run own --estimators aims_"), Words({"aims_d"}));
  EXPECT_EQ(in_bash("aims run own --estimators lio,aims_"), Words({"lio,aims_d"}));
}

/// Every option that the help of a command shows is one that shells complete.
TEST_F(Completion, KnowsEveryOptionOfTheHelp) {
  for (const char* command : {"run", "sweep", "score", "estimate", "study compare", "info"}) {
    const std::string help = aims(std::string(command) + " --help").output;
    const Words completed = in_bash("aims " + std::string(command) + " --");
    const std::regex option("\n  (?:-[a-z],)?(--[a-z-]+)");
    for (std::sregex_iterator i(help.begin(), help.end(), option), end; i != end; ++i) {
      EXPECT_TRUE(completed.contains((*i)[1])) << command << " " << (*i)[1];
    }
    EXPECT_FALSE(completed.empty()) << command;
  }
}

TEST_F(Completion, OfZshIsReadByIt) {
  if (shell("command -v zsh").exit_code != 0) GTEST_SKIP() << "zsh is not installed";
  const Outcome outcome = shell(AIMS_COMMAND
                                " completion zsh > _aims && zsh -n _aims && zsh -fc '"
                                "compdef() { :; }; compset() { false; }; _files() { :; }; "
                                "compadd() { shift; print -l -- \"$@\"; }; "
                                "words=(" AIMS_COMMAND " study c); CURRENT=3; source ./_aims'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_TRUE(holds(outcome, "compare\n")) << outcome.output;
}

}  // namespace
}  // namespace aims
