// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "live/program.hpp"

namespace aims {

/// Parses the arguments of a program. Its exit code where it ends with that: help was printed, or
/// the arguments are wrong.
inline std::optional<int> exit_after_parsing(CLI::App& app, const char* program, int argc,
                                             char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return kLiveOk;
  } catch (const CLI::ParseError& error) {
    return report_bad_input(program, fmt::format("{}; see --help", error.what()));
  }
  return std::nullopt;
}

}  // namespace aims
