// SPDX-License-Identifier: BSD-3-Clause
#include "live/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace aims {
namespace {

// Exit codes.
constexpr int kOk = 0;
constexpr int kBadInput = 2;
constexpr int kInternal = 3;

int report(const CLI::App& app, const std::string& message, int exit_code) {
  fmt::print(stderr, "{}: {}\n", app.get_name(), message);
  return exit_code;
}

}  // namespace

void print_line(const std::string& text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

int run_program(CLI::App& app, std::vector<std::string> arguments,
                const std::function<Result<void>()>& run) {
  std::ranges::reverse(arguments);  // the order that CLI11 expects
  try {
    app.parse(arguments);
    const auto done = run();
    return done ? kOk : report(app, done.error().message, kBadInput);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return kOk;
  } catch (const CLI::ParseError& error) {
    return report(app, fmt::format("{}; see --help", error.what()), kBadInput);
  } catch (const std::exception& error) {
    return report(app, fmt::format("internal error: {}", error.what()), kInternal);
  }
}

}  // namespace aims
