// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Prints a line at once: who starts the program may read from a pipe.
void print_line(const std::string& text);

/// Parses the arguments, without the program's name, then runs it. Its exit code: 0, also after
/// help; 2 for bad arguments or an error, which is a line on standard error; 3 for an exception.
int run_program(CLI::App& app, std::vector<std::string> arguments,
                const std::function<Result<void>()>& run);

}  // namespace aims
