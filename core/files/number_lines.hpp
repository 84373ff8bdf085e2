// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"

namespace aims {

/// Iterates over the lines of a text that are neither blank nor comments ('#').
class LineReader {
 public:
  /// Errors call the text `name`; both must outlive the reader. A byte order mark is passed over.
  LineReader(std::string_view text, std::string_view name);

  /// The next such line, or nothing at the end.
  std::optional<std::string_view> next();

  /// As `next`, together with the lines that a text in double quotes in it goes on over.
  std::optional<std::string_view> next_record();

  /// Number of the last line returned, from 1, blank lines and comments included.
  int number() const { return number_; }

  /// The error "name:line: message" for the last line returned.
  tl::unexpected<Error> error(std::string_view message) const;

 private:
  std::string_view rest_;
  std::string_view name_;
  int number_ = 0;
  int further_ = 0;  ///< lines of the last record after its first
};

/// The words of a line, separated by blanks and tabs.
std::vector<std::string_view> words_of(std::string_view line);

/// The word as a number; nan and inf only when `finite` is false.
std::optional<double> parse_number(std::string_view word, bool finite = true);

/// Seconds as nanoseconds: exact when written as plain decimals of at most nine digits; other
/// notations (exponents, more digits) are rounded to the nearest nanosecond.
std::optional<Time> parse_stamp(std::string_view word);

}  // namespace aims
