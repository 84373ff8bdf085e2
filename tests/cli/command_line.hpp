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

/// A scenario of a metre of a corridor, thinly seen.
inline const std::string kMetreWalk =
    "scene: {corridor: {length: 10}}\n"
    "route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]}\n"
    "lidar: {columns: 200}\n";

/// Runs the real `aims` command in a folder of its own, as a user would.
class CommandLine : public ::testing::Test {
 protected:
  Outcome aims(const std::string& arguments) const {
    return shell("'" AIMS_COMMAND "' " + arguments);
  }

  /// Any command line.
  Outcome shell(const std::string& line) const {
    const std::string command = "cd '" + folder_.path().string() +
                                "' && export XDG_CACHE_HOME=\"$PWD/.cache\" && " + line +
                                " 2>&1 </dev/null";
    Outcome outcome;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (fgets(buffer.data(), buffer.size(), pipe) != nullptr) outcome.output += buffer.data();
    outcome.exit_code = WEXITSTATUS(pclose(pipe));
    return outcome;
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
  }

  std::string scenario(const std::string& yaml) const {
    write("my.yaml", yaml);
    return "my.yaml";
  }

  static bool holds(const Outcome& outcome, const std::string& part) {
    return outcome.output.find(part) != std::string::npos;
  }

  TemporaryFolder folder_;
};

}  // namespace aims::testing
