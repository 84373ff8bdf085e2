// SPDX-License-Identifier: BSD-3-Clause
#include "cli/terminal.hpp"

#include <cerrno>
#include <sstream>
#include <string>
#include <system_error>

#include "core/text.hpp"

namespace aims {

void write_terminal(std::FILE* stream, std::string_view text) {
  const std::string shown = terminal_text(text);
  std::fwrite(shown.data(), 1, shown.size(), stream);
}

void print_error(std::string_view message) { write_terminal(stderr, line_text(message) + "\n"); }

void print_failure(std::string_view message) {
  const std::size_t begin = message.find("\nTraceback (most recent call last):");
  print_error(message.substr(0, begin));
  if (begin == std::string_view::npos) return;
  std::istringstream lines{std::string(message.substr(begin + 1))};
  for (std::string line; std::getline(lines, line);) print_error(line);
}

Result<void> finish_output() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0) return {};
  const int code = errno;
  return failure(code == 0 ? std::string("standard output cannot be written")
                           : "standard output cannot be written: " +
                                 std::generic_category().message(code));
}

}  // namespace aims
