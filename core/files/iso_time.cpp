// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/iso_time.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstddef>

namespace aims {
namespace {

/// Takes what an instant consists of from the front of a text.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}

  bool at_end() const { return rest_.empty(); }

  /// A number of exactly so many digits.
  std::optional<int> number(std::size_t digits) {
    if (digits_ahead() < digits) return std::nullopt;
    int value = 0;
    for (const char digit : rest_.substr(0, digits)) value = 10 * value + (digit - '0');
    rest_.remove_prefix(digits);
    return value;
  }

  /// Any one of these characters.
  std::optional<char> one_of(std::string_view wanted) {
    if (rest_.empty() || wanted.find(rest_.front()) == std::string_view::npos) return std::nullopt;
    const char found = rest_.front();
    rest_.remove_prefix(1);
    return found;
  }

  /// The digits behind a decimal point [ns].
  std::optional<Duration> fraction() {
    const std::size_t digits = digits_ahead();
    if (digits == 0) return std::nullopt;
    Duration value = 0;
    for (std::size_t i = 0; i < 9; ++i) value = 10 * value + (i < digits ? rest_[i] - '0' : 0);
    rest_.remove_prefix(digits);
    return value;
  }

 private:
  std::size_t digits_ahead() const {
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    return static_cast<std::size_t>(std::ranges::find_if_not(rest_, is_digit) - rest_.begin());
  }

  std::string_view rest_;
};

/// Seconds since 1970 of the start of the day.
std::optional<Time> take_day(Cursor& cursor) {
  constexpr int kFirst = 1678, kLast = 2261;  // years that 64 bits of ns hold
  const auto year = cursor.number(4);
  if (!year || !cursor.one_of("-")) return std::nullopt;
  const auto month = cursor.number(2);
  if (!month || !cursor.one_of("-")) return std::nullopt;
  const auto day = cursor.number(2);
  if (!day || *year < kFirst || *year > kLast) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date).time_since_epoch().count() * 86'400 * kSecond;
}

std::optional<Duration> take_time_of_day(Cursor& cursor) {
  const auto hour = cursor.number(2);
  if (!hour || !cursor.one_of(":")) return std::nullopt;
  const auto minute = cursor.number(2);
  if (!minute || !cursor.one_of(":")) return std::nullopt;
  const auto second = cursor.number(2);
  if (!second || *hour > 23 || *minute > 59 || *second > 60) return std::nullopt;
  const Duration whole = ((*hour * 60 + *minute) * 60 + *second) * kSecond;
  if (!cursor.one_of(".,")) return whole;
  const auto part = cursor.fraction();
  return part ? std::optional(whole + *part) : std::nullopt;
}

/// The offset from UTC behind its sign.
std::optional<Duration> take_offset(Cursor& cursor) {
  const auto hours = cursor.number(2);
  if (!hours || *hours > 23) return std::nullopt;
  cursor.one_of(":");
  const int minutes = cursor.number(2).value_or(0);
  return (*hours * 60 + minutes) * 60 * kSecond;
}

}  // namespace

std::optional<IsoTime> parse_iso_time(std::string_view text) {
  Cursor cursor(text);
  const auto day = take_day(cursor);
  if (!day || !cursor.one_of("T t")) return std::nullopt;
  const auto time_of_day = take_time_of_day(cursor);
  if (!time_of_day) return std::nullopt;
  IsoTime result{*day + *time_of_day, true};
  const char zone = cursor.one_of("Zz+-").value_or(' ');
  if (zone == ' ') {
    result.has_zone = false;
  } else if (zone == '+' || zone == '-') {
    const auto offset = take_offset(cursor);
    if (!offset) return std::nullopt;
    result.time -= zone == '+' ? *offset : -*offset;
  }
  if (!cursor.at_end()) return std::nullopt;
  return result;
}

}  // namespace aims
