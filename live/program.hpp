// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>

namespace aims {

// Exit codes of the live programs.
inline constexpr int kLiveOk = 0;
inline constexpr int kLiveBadInput = 2;
inline constexpr int kLiveInternal = 3;

/// Prints "PROGRAM: message" to standard error; the exit code of bad input.
inline int report_bad_input(const char* program, const std::string& message) {
  fmt::print(stderr, "{}: {}\n", program, message);
  return kLiveBadInput;
}

/// What `main_of` returns; an exception is printed and becomes an exit code.
template <class Main>
int guarded_main(const char* program, const Main& main_of) {
  try {
    return main_of();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: internal error: {}\n", program, error.what());
    return kLiveInternal;
  }
}

}  // namespace aims
