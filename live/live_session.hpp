// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/error.hpp"
#include "live/live_options.hpp"
#include "live/transport.hpp"

namespace aims {

// Exit codes of the live programs.
inline constexpr int kLiveOk = 0;
inline constexpr int kLiveBadInput = 2;
inline constexpr int kLiveInternal = 3;

/// Prints a line at once: who starts the program may read from a pipe.
void print_line(const std::string& text);

/// Prints "PROGRAM: error"; returns the exit code.
int report_bad_input(const std::string& program, const Error& error);

/// Gathers topics, decides how to read them, then estimates and publishes until the node is asked
/// to end. Returns the exit code.
int run_live(Transport& transport, const LiveOptions& options, const std::string& program);

}  // namespace aims
