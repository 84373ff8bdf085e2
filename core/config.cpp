// SPDX-License-Identifier: BSD-3-Clause
#include "core/config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>

namespace aims {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// A finite number that fills the whole text, or nothing.
template <class Number>
std::optional<Number> parse(std::string_view text) {
  text = trimmed(text);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(static_cast<double>(value))) return std::nullopt;
  return value;
}

/// Entries of "[a, b, c]", or nothing when the brackets are missing.
std::optional<std::vector<std::string>> parse_sequence(std::string_view text) {
  text = trimmed(text);
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return std::nullopt;
  std::string_view rest = trimmed(text.substr(1, text.size() - 2));
  std::vector<std::string> entries;
  while (!rest.empty()) {
    const auto comma = rest.find(',');
    entries.emplace_back(trimmed(rest.substr(0, comma)));
    rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
  }
  return entries;
}

template <class Vector>
bool assign_vector(Vector& value, const Range& range, std::string_view text) {
  const auto entries = parse_sequence(text);
  if (!entries || entries->size() != static_cast<std::size_t>(value.size())) return false;
  Vector parsed;
  for (int i = 0; i < parsed.size(); ++i) {
    const auto number = parse<double>((*entries)[i]);
    if (!number || !range.contains(*number)) return false;
    parsed[i] = *number;
  }
  value = parsed;
  return true;
}

std::string with_range(std::string_view what, const Range& range) {
  const std::string bounds = range.text();
  return bounds.empty() ? std::string(what) : fmt::format("{} {}", what, bounds);
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row.back();
}

}  // namespace

bool Range::contains(double value) const {
  const bool above = min_included ? value >= min : value > min;
  const bool below = max_included ? value <= max : value < max;
  return above && below;
}

std::string Range::text() const {
  const bool bounded_below = std::isfinite(min);
  const bool bounded_above = std::isfinite(max);
  if (bounded_below && bounded_above) {
    return fmt::format("in {}{:g}, {:g}{}", min_included ? '[' : '(', min, max,
                       max_included ? ']' : ')');
  }
  if (bounded_below) return fmt::format("{} {:g}", min_included ? ">=" : ">", min);
  if (bounded_above) return fmt::format("{} {:g}", max_included ? "<=" : "<", max);
  return {};
}

void Fields::number(std::string_view name, double& value, Spec spec) {
  const Range range = spec.range;
  auto assign = [&value, range](std::string_view text) {
    const auto parsed = parse<double>(text);
    if (!parsed || !range.contains(*parsed)) return false;
    value = *parsed;
    return true;
  };
  add(name, std::move(spec), with_range("a number", range),
      [&value] { return fmt::format("{}", value); }, std::move(assign));
}

void Fields::integer(std::string_view name, int& value, Spec spec) {
  const Range range = spec.range;
  auto assign = [&value, range](std::string_view text) {
    const auto parsed = parse<int>(text);
    if (!parsed || !range.contains(*parsed)) return false;
    value = *parsed;
    return true;
  };
  add(name, std::move(spec), with_range("an integer", range),
      [&value] { return fmt::format("{}", value); }, std::move(assign));
}

void Fields::flag(std::string_view name, bool& value, Spec spec) {
  auto assign = [&value](std::string_view text) {
    if (text != "true" && text != "false") return false;
    value = text == "true";
    return true;
  };
  add(name, std::move(spec), "true or false",
      [&value] { return std::string(value ? "true" : "false"); }, std::move(assign));
}

void Fields::text(std::string_view name, std::string& value, Spec spec) {
  auto assign = [&value](std::string_view text) {
    value = text;
    return true;
  };
  add(name, std::move(spec), "a text", [&value] { return value; }, std::move(assign));
}

void Fields::texts(std::string_view name, std::vector<std::string>& value, Spec spec) {
  auto assign = [&value](std::string_view text) {
    auto entries = parse_sequence(text);
    if (!entries) return false;
    value = std::move(*entries);
    return true;
  };
  add(name, std::move(spec), "a list of texts like [a, b]",
      [&value] { return fmt::format("[{}]", fmt::join(value, ", ")); }, std::move(assign));
}

void Fields::vector(std::string_view name, Eigen::Vector3d& value, Spec spec) {
  const Range range = spec.range;
  add(name, std::move(spec), with_range("three numbers like [x, y, z]", range),
      [&value] { return fmt::format("[{}, {}, {}]", value.x(), value.y(), value.z()); },
      [&value, range](std::string_view text) { return assign_vector(value, range, text); });
}

void Fields::vector(std::string_view name, Eigen::Vector2d& value, Spec spec) {
  const Range range = spec.range;
  add(name, std::move(spec), with_range("two numbers like [x, y]", range),
      [&value] { return fmt::format("[{}, {}]", value.x(), value.y()); },
      [&value, range](std::string_view text) { return assign_vector(value, range, text); });
}

const Parameter* Fields::find(std::string_view key) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [key](const Parameter& each) { return each.key == key; });
  return found == parameters_.end() ? nullptr : &*found;
}

std::string Fields::full_key(std::string_view name) const {
  return prefix_.empty() ? std::string(name) : prefix_ + "." + std::string(name);
}

void Fields::add(std::string_view name, Spec spec, std::string expected,
                 std::function<std::string()> text, std::function<bool(std::string_view)> assign) {
  parameters_.push_back(
      {full_key(name), std::move(spec), std::move(expected), std::move(text), std::move(assign)});
}

Result<void> assign(const Fields& fields, std::string_view key, std::string_view value) {
  const Parameter* parameter = fields.find(key);
  if (parameter == nullptr) return failure(unknown_key_message(fields, key));
  if (!parameter->assign(value)) {
    return failure(fmt::format("{}: '{}' is not {}", key, value, parameter->expected));
  }
  return {};
}

std::string near_match(std::string_view word, const std::vector<std::string>& candidates) {
  const std::size_t tolerance = std::max<std::size_t>(2, word.size() / 3);
  std::string nearest;
  std::size_t nearest_distance = tolerance + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < nearest_distance) {
      nearest_distance = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string unknown_key_message(const Fields& fields, std::string_view key) {
  std::vector<std::string> keys;
  for (const Parameter& parameter : fields.parameters()) keys.push_back(parameter.key);
  for (const ListField& list : fields.lists()) keys.push_back(list.key);
  const std::string near = near_match(key, keys);
  if (near.empty()) return fmt::format("unknown key '{}'", key);
  return fmt::format("unknown key '{}'; did you mean '{}'?", key, near);
}

}  // namespace aims
