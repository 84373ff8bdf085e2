// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// Writes text of the program to a standard stream: names in it may hold any bytes, and reach the
/// terminal as `terminal_text`. A failure to write shows in `finish_output`.
void write_terminal(std::FILE* stream, std::string_view text);

/// As fmt::print, through `write_terminal`. Commands print in no other way.
template <class... Arguments>
void print_out(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_terminal(stdout, fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Prints a table of scores, without its less telling columns where `COLUMNS`, the terminal or, of
/// what is none, 120 characters are narrower; says which are only in `file`.
void print_scores_table(const TextTable& table, std::string_view file);

/// An error or a note on standard error, in one line.
void print_error(std::string_view message);

/// Prints an error; the traceback of one in Python line by line below it.
void print_failure(std::string_view message);

/// Flushes standard output. Error when not all of it could be written.
Result<void> finish_output();

}  // namespace aims
