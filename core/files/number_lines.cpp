// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/number_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/text.hpp"

namespace aims {
namespace {

/// "+9.81" without its sign.
std::string_view without_plus(std::string_view word) {
  const bool plus =
      word.size() > 1 && word[0] == '+' && (word[1] == '.' || (word[1] >= '0' && word[1] <= '9'));
  return plus ? word.substr(1) : word;
}

}  // namespace

LineReader::LineReader(std::string_view text, std::string_view name) : rest_(text), name_(name) {
  if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
}

std::optional<std::string_view> LineReader::next() {
  while (!rest_.empty()) {
    number_ += 1 + further_;
    further_ = 0;
    const std::string_view line = take_until(rest_, '\n');
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string_view::npos && line[first] != '#') return line;
  }
  return std::nullopt;
}

std::optional<std::string_view> LineReader::next_record() {
  const auto line = next();
  if (!line) return line;
  const auto quotes = [](std::string_view text) {
    return std::count(text.begin(), text.end(), '"');
  };
  std::string_view record = *line;
  for (auto seen = quotes(record); seen % 2 != 0 && !rest_.empty();) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    seen += quotes(rest_.substr(0, end));
    record = {record.data(), record.size() + 1 + end};  // the lines follow each other in memory
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++further_;
  }
  return record;
}

tl::unexpected<Error> LineReader::error(std::string_view message) const {
  return failure(line_text(fmt::format("{}:{}: {}", name_, number_, message)));
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t start = line.find_first_not_of(" \t\r");
  while (start != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", start), line.size());
    words.push_back(line.substr(start, end - start));
    start = line.find_first_not_of(" \t\r", end);
  }
  return words;
}

std::optional<double> parse_number(std::string_view word, bool finite) {
  const auto value = number_from<double>(without_plus(word));
  return value && finite && !std::isfinite(*value) ? std::nullopt : value;
}

std::optional<Time> parse_stamp(std::string_view word) {
  word = without_plus(word);
  const bool negative = word.starts_with('-');
  const std::string_view unsigned_word = negative ? word.substr(1) : word;
  const std::size_t dot = std::min(unsigned_word.find('.'), unsigned_word.size());
  std::string decimals(dot < unsigned_word.size() ? unsigned_word.substr(dot + 1) : "");
  const bool exact = decimals.size() <= 9;
  decimals.resize(9, '0');
  const auto seconds = number_from<std::uint64_t>(unsigned_word.substr(0, dot));
  const auto fraction = number_from<std::uint64_t>(decimals);
  constexpr auto kMaxSeconds =
      static_cast<std::uint64_t>(std::numeric_limits<Time>::max() / kSecond);
  if (exact && seconds && fraction) {
    if (*seconds >= kMaxSeconds) return std::nullopt;
    const auto stamp = static_cast<Time>(*seconds) * kSecond + static_cast<Time>(*fraction);
    return negative ? -stamp : stamp;
  }
  const auto number = parse_number(word);
  if (!number || std::abs(*number) >= static_cast<double>(kMaxSeconds)) return std::nullopt;
  return from_seconds(*number);
}

}  // namespace aims
