// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bench/cli/exit_code.hpp"
#include "core/error.hpp"

namespace aims {

/// Says what was wrong with what `command` was given, on standard error; the exit code for it.
int bad_input(const char* command, const Error& error);

/// An option that may be given several times, one value each.
CLI::Option* add_repeatable(CLI::App& command, const std::string& name,
                            std::vector<std::string>& values, const std::string& meaning);

/// --jobs N.
void add_jobs_option(CLI::App& command, int& jobs, const std::string& meaning);

/// As many as there are cores.
int default_jobs();

}  // namespace aims
