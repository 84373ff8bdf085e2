// SPDX-License-Identifier: BSD-3-Clause
// Commands that are programs of their own, with a program that stands in for them.
#include <gtest/gtest.h>

#include <string>

#include "tests/cli/command_line.hpp"

namespace aims {
namespace {

using testing::Outcome;

class ExternalCommands : public testing::CommandLine {
 protected:
  ExternalCommands() {
    EXPECT_EQ(shell("cp '" AIMS_COMMAND "' aims && mkdir other").exit_code, 0);
    write("other/aims_watch",
          "#!/bin/sh\n[ \"$1\" = --help ] && { echo '  --port INT'; exit; }\n"
          "echo \"watch got $*\"; exit 5\n");
    EXPECT_EQ(shell("chmod +x other/aims_watch").exit_code, 0);
  }
  /// The copy, of which no other program lies in the same folder.
  Outcome copy(const std::string& path, const std::string& arguments) const {
    return shell("PATH=\"" + path + "\" ./aims " + arguments);
  }
};

TEST_F(ExternalCommands, RunTheProgramOnThePathOrBesideThisOne) {
  const Outcome on_path = copy("/nowhere:$PWD/other:/bin", "watch a --port 1 'b c'");
  EXPECT_EQ(on_path.output, "watch got a --port 1 b c\n");
  EXPECT_EQ(on_path.exit_code, 5) << "that of the program";
  EXPECT_EQ(shell("cp other/aims_watch .").exit_code, 0);
  EXPECT_EQ(copy("/nowhere", "watch").output, "watch got \n");
}

TEST_F(ExternalCommands, AreListedWhereTheyAreInstalled) {
  const Outcome help = copy("$PWD/other:/bin", "--help");
  EXPECT_TRUE(holds(help, "\n  watch ")) << help.output;
  EXPECT_FALSE(holds(help, "\n  live ")) << help.output;
}

TEST_F(ExternalCommands, NameThePackageWhereTheyAreNot) {
  const Outcome missing = copy("/nowhere", "live --robot go2");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_TRUE(holds(missing, "aims live: the program aims_live is not installed"))
      << missing.output;
  EXPECT_TRUE(holds(missing, "aims-live_")) << missing.output;
  EXPECT_TRUE(holds(copy("/nowhere", "wath"), "did you mean 'aims watch'?"));
}

TEST_F(ExternalCommands, AreCompletedWithTheOptionsOfTheProgram) {
  const Outcome options = shell(
      "PATH=\"$PWD/other:$PATH\" bash -c 'source <(./aims completion bash); "
      "COMP_WORDS=(aims watch --p); COMP_CWORD=2; _aims ./aims; echo \"${COMPREPLY[@]}\"'");
  EXPECT_EQ(options.output, "--port\n");
}

}  // namespace
}  // namespace aims
