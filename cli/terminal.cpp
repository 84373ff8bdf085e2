// SPDX-License-Identifier: BSD-3-Clause
#include "cli/terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>
#include <vector>

#include "core/text.hpp"

namespace aims {

void write_terminal(std::FILE* stream, std::string_view text) {
  const std::string shown = terminal_text(text);
  if (stream == stderr) std::fflush(stdout);  // in the order of printing where both are one
  std::fwrite(shown.data(), 1, shown.size(), stream);
}

namespace {

/// Columns of scores that a narrow terminal goes without, the first one first.
constexpr std::array kLeast = {"ATE SE(3)",   "ATE Sim(3)", "path error deg", "CPU",
                               "x real time", "heading",    "tracked",        "path error",
                               "M_end",       "poses",      "ATE start",      "max |z|",
                               "M_list(",     "within 1 %"};

/// Characters in a line of standard output; `COLUMNS` of the environment comes first.
std::size_t output_width() {
  constexpr std::size_t kWithoutTerminal = 120;
  if (const char* columns = std::getenv("COLUMNS"); columns != nullptr) {
    if (const auto width = number_from<std::size_t>(columns); width > std::size_t{0}) return *width;
  }
  winsize size{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : kWithoutTerminal;
}

/// "start a, b,\n  c\n" in lines of at most `width` characters.
std::string list_lines(std::string line, const std::vector<std::string>& items, std::size_t width) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool last = i + 1 == items.size();
    if (i > 0 && line.size() + items[i].size() + (last ? 0 : 1) > width) {
      line.pop_back();
      text += line + "\n";
      line = "  ";
    }
    line += items[i] + (last ? "\n" : ", ");
  }
  return text + line;
}

}  // namespace

void print_scores_table(const TextTable& table, std::string_view file) {
  std::vector<std::string> left_out;
  print_out("{}", to_text(narrowed(table, output_width(), kLeast, left_out)));
  if (left_out.empty()) return;
  print_out("{}", list_lines(fmt::format("in {} alone: ", file), left_out, output_width()));
}

void print_error(std::string_view message) { write_terminal(stderr, line_text(message) + "\n"); }

void print_failure(std::string_view message) {
  const std::size_t begin = message.find("\nTraceback (most recent call last):");
  print_error(message.substr(0, begin));
  if (begin == std::string_view::npos) return;
  for (const std::string& line : split(message.substr(begin + 1), '\n')) print_error(line);
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
