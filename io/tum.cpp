// SPDX-License-Identifier: BSD-3-Clause
#include "io/tum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "io/atomic_file.hpp"

namespace aims {
namespace {

constexpr std::size_t kColumns = 8;
constexpr double kNormTolerance = 1e-3;

std::string stamp_text(Time stamp) {
  const bool negative = stamp < 0;
  // Negated as unsigned, so that the smallest integer has a magnitude too.
  const auto magnitude = negative ? std::uint64_t{0} - static_cast<std::uint64_t>(stamp)
                                  : static_cast<std::uint64_t>(stamp);
  const auto second = static_cast<std::uint64_t>(kSecond);
  return fmt::format("{}{}.{:09}", negative ? "-" : "", magnitude / second, magnitude % second);
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

std::optional<double> parse_number(std::string_view word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<std::uint64_t> parse_digits(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// Seconds as exact nanoseconds when written as plain decimals of at most nine digits; other
/// notations (exponents, more digits) are rounded to the nearest nanosecond.
std::optional<Time> parse_stamp(std::string_view word) {
  const bool negative = word.starts_with('-');
  const std::string_view unsigned_word = negative ? word.substr(1) : word;
  const std::size_t dot = std::min(unsigned_word.find('.'), unsigned_word.size());
  std::string decimals(dot < unsigned_word.size() ? unsigned_word.substr(dot + 1) : "");
  const bool exact = decimals.size() <= 9;
  decimals.resize(9, '0');
  const auto seconds = parse_digits(unsigned_word.substr(0, dot));
  const auto fraction = parse_digits(decimals);
  constexpr auto kMostSeconds =
      static_cast<std::uint64_t>(std::numeric_limits<Time>::max() / kSecond);
  if (exact && seconds && fraction) {
    if (*seconds >= kMostSeconds) return std::nullopt;
    const auto stamp = static_cast<Time>(*seconds) * kSecond + static_cast<Time>(*fraction);
    return negative ? -stamp : stamp;
  }
  const auto number = parse_number(word);
  if (!number || std::abs(*number) >= static_cast<double>(kMostSeconds)) return std::nullopt;
  return from_seconds(*number);
}

Result<StampedPose> parse_line(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  if (words.size() != kColumns) {
    return failure(
        fmt::format("expected 8 columns 'stamp x y z qx qy qz qw', found {}", words.size()));
  }
  const auto stamp = parse_stamp(words[0]);
  if (!stamp) return failure(fmt::format("expected a stamp in seconds, found '{}'", words[0]));
  std::array<double, kColumns> v{};
  for (std::size_t i = 1; i < kColumns; ++i) {
    const auto number = parse_number(words[i]);
    if (!number) {
      return failure(
          fmt::format("column {}: expected a finite number, found '{}'", i + 1, words[i]));
    }
    v[i] = *number;
  }
  Eigen::Quaterniond rotation(v[7], v[4], v[5], v[6]);
  const double norm = rotation.norm();
  if (!(std::abs(norm - 1.0) <= kNormTolerance)) {
    return failure(fmt::format("expected a quaternion of norm 1, found norm {:g}", norm));
  }
  // Only a norm that is off by more than rounding is touched, so that a round trip is exact.
  if (std::abs(norm - 1.0) > 1e-14) rotation.normalize();
  return StampedPose{*stamp, {rotation, {v[1], v[2], v[3]}}};
}

}  // namespace

std::string tum_text(const Trajectory& trajectory) {
  fmt::memory_buffer out;
  for (const StampedPose& each : trajectory) {
    const Eigen::Vector3d& p = each.pose.translation;
    const Eigen::Quaterniond& q = each.pose.rotation;
    fmt::format_to(std::back_inserter(out), "{} {} {} {} {} {} {} {}\n", stamp_text(each.stamp),
                   p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return fmt::to_string(out);
}

Result<Trajectory> parse_tum(std::string_view text, const std::string& name) {
  Trajectory trajectory;
  int line_number = 0;
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    const auto pose = parse_line(line);
    if (!pose) return failure(fmt::format("{}:{}: {}", name, line_number, pose.error().message));
    if (!trajectory.empty() && pose->stamp <= trajectory.back().stamp) {
      return failure(fmt::format("{}:{}: expected a stamp after {}, found {}", name, line_number,
                                 stamp_text(trajectory.back().stamp), stamp_text(pose->stamp)));
    }
    trajectory.push_back(*pose);
  }
  return trajectory;
}

Result<void> write_tum(const std::filesystem::path& file, const Trajectory& trajectory) {
  return write_file_atomically(file, tum_text(trajectory));
}

Result<Trajectory> read_tum(const std::filesystem::path& file) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse_tum(*text, file.string());
}

}  // namespace aims
