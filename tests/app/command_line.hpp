// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace aims::testing {

/// What a command returned and said.
struct Outcome {
  int exit_code = -1;
  std::string output;  ///< standard output and error
};

/// Runs the real `aims` command in a folder of its own, as a user would.
class CommandLine : public ::testing::Test {
 protected:
  Outcome aims(const std::string& arguments) const {
    return shell("'" AIMS_COMMAND "' " + arguments);
  }

  /// Any command line.
  Outcome shell(const std::string& line) const {
    const std::string command =
        "cd '" + folder_.path().string() + "' && " + line + " 2>&1 </dev/null";
    Outcome outcome;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (fgets(buffer.data(), buffer.size(), pipe) != nullptr) outcome.output += buffer.data();
    outcome.exit_code = WEXITSTATUS(pclose(pipe));
    return outcome;
  }

  std::string scenario(const std::string& yaml) const {
    const std::filesystem::path file = folder_.path() / "my.yaml";
    std::ofstream(file) << yaml;
    return file.filename().string();
  }

  TemporaryFolder folder_;
};

}  // namespace aims::testing
