// SPDX-License-Identifier: BSD-3-Clause
#include "core/config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/text.hpp"

namespace aims {
namespace {

/// A finite number that fills the whole text, or nothing.
template <class Number>
std::optional<Number> parse(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const auto value = number_from<Number>(text);
  return value && std::isfinite(static_cast<double>(*value)) ? value : std::nullopt;
}

/// Removes a double-quoted entry from the front of `rest`; nothing when its quote never closes.
std::optional<std::string> take_quoted(std::string_view& rest) {
  std::string entry;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] == '"') {
      rest = trimmed(rest.substr(i + 1));
      return entry;
    }
    if (rest[i] == '\\' && i + 1 < rest.size()) ++i;
    entry += rest[i];
  }
  return std::nullopt;
}

/// Removes an unquoted entry from the front of `rest`; nothing when it is empty.
std::optional<std::string> take_plain(std::string_view& rest) {
  const auto end = std::min(rest.find(','), rest.size());
  const std::string entry(trimmed(rest.substr(0, end)));
  rest = rest.substr(end);
  if (entry.empty()) return std::nullopt;
  return entry;
}

std::string quoted_if_needed(const std::string& entry) {
  if (!entry.empty() && entry.find_first_of(" \t,[]\"\\") == std::string::npos) return entry;
  std::string quoted = "\"";
  for (const char c : entry) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

template <class Vector>
bool assign_vector(Vector& value, const Range& range, std::string_view text) {
  const auto entries = sequence_entries(text);
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

bool is_number(const Parameter& parameter) {
  return parameter.kind == ParameterKind::kNumber || parameter.kind == ParameterKind::kInteger;
}

bool is_sequence(const Parameter& parameter) {
  return parameter.kind == ParameterKind::kVector || parameter.kind == ParameterKind::kNumbers ||
         parameter.kind == ParameterKind::kTexts;
}

std::string option_proposal(const Parameter& parameter, std::string_view value) {
  const std::string near = near_match(value, parameter.options);
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", near);
}

template <class Number>
void Fields::add_number(std::string_view name, ParameterKind kind, Number& value, Spec spec,
                        std::string_view what) {
  const Range range = spec.range;
  auto assign = [&value, range](std::string_view text) {
    const auto parsed = parse<Number>(text);
    if (!parsed || !range.contains(*parsed)) return false;
    value = *parsed;
    return true;
  };
  add(
      name, kind, std::move(spec), with_range(what, range),
      [&value] { return fmt::format("{}", value); }, std::move(assign));
}

void Fields::number(std::string_view name, double& value, Spec spec) {
  add_number(name, ParameterKind::kNumber, value, std::move(spec), "a number");
}

void Fields::integer(std::string_view name, int& value, Spec spec) {
  add_number(name, ParameterKind::kInteger, value, std::move(spec), "an integer");
}

void Fields::flag(std::string_view name, bool& value, Spec spec) {
  auto assign = [&value](std::string_view text) {
    if (text != "true" && text != "false") return false;
    value = text == "true";
    return true;
  };
  add(
      name, ParameterKind::kFlag, std::move(spec), "true or false",
      [&value] { return std::string(value ? "true" : "false"); }, std::move(assign));
}

void Fields::text(std::string_view name, std::string& value, Spec spec) {
  auto assign = [&value](std::string_view text) {
    value = text;
    return true;
  };
  add(
      name, ParameterKind::kText, std::move(spec), "a text", [&value] { return value; },
      std::move(assign));
}

void Fields::texts(std::string_view name, std::vector<std::string>& value, Spec spec) {
  auto assign = [&value](std::string_view text) {
    auto entries = sequence_entries(text);
    if (!entries) return false;
    value = std::move(*entries);
    return true;
  };
  add(
      name, ParameterKind::kTexts, std::move(spec), "a list of texts like [a, b]",
      [&value] { return sequence_text(value); }, std::move(assign));
}

void Fields::numbers(std::string_view name, std::vector<double>& value, Spec spec) {
  const Range range = spec.range;
  auto assign = [&value, range](std::string_view text) {
    const auto entries = sequence_entries(text);
    if (!entries) return false;
    std::vector<double> parsed;
    for (const std::string& entry : *entries) {
      const auto number = parse<double>(entry);
      if (!number || !range.contains(*number)) return false;
      parsed.push_back(*number);
    }
    value = std::move(parsed);
    return true;
  };
  add(
      name, ParameterKind::kNumbers, std::move(spec),
      with_range("a list of numbers like [a, b], each", range),
      [&value] { return fmt::format("[{}]", fmt::join(value, ", ")); }, std::move(assign));
}

template <class Vector>
void Fields::add_vector(std::string_view name, Vector& value, Spec spec, std::string_view what) {
  const Range range = spec.range;
  add(
      name, ParameterKind::kVector, std::move(spec), with_range(what, range),
      [&value] {
        return fmt::format("[{}]", fmt::join(value.data(), value.data() + value.size(), ", "));
      },
      [&value, range](std::string_view text) { return assign_vector(value, range, text); });
}

void Fields::vector(std::string_view name, Eigen::Vector3d& value, Spec spec) {
  add_vector(name, value, std::move(spec), "three numbers like [x, y, z]");
}

void Fields::vector(std::string_view name, Eigen::Vector2d& value, Spec spec) {
  add_vector(name, value, std::move(spec), "two numbers like [x, y]");
}

const Parameter* Fields::find(std::string_view key) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [key](const Parameter& each) { return each.key == key; });
  return found == parameters_.end() ? nullptr : &*found;
}

std::string Fields::full_key(std::string_view name) const {
  return prefix_.empty() ? std::string(name) : prefix_ + "." + std::string(name);
}

void Fields::add(std::string_view name, ParameterKind kind, Spec spec, std::string expected,
                 std::function<std::string()> text, std::function<bool(std::string_view)> assign) {
  parameters_.push_back({full_key(name), kind, std::move(spec), std::move(expected),
                         std::move(text), std::move(assign)});
}

void Fields::idle_below_switch() {
  const Parameter* enabled = find(full_key("enabled"));
  if (enabled == nullptr || enabled->text() != "false") return;
  const std::string start = prefix_ + ".";
  for (Parameter& parameter : parameters_) {
    if (&parameter == enabled || !parameter.key.starts_with(start)) continue;
    parameter.idle = enabled->key + " is false";
  }
}

void Fields::group_of(std::string_view name, Fields fields) {
  const std::string start = full_key(name) + ".";
  for (Parameter& parameter : fields.parameters_) {
    parameter.key = start + parameter.key;
    parameters_.push_back(std::move(parameter));
  }
  for (ListField& list : fields.lists_) {
    list.key = start + list.key;
    lists_.push_back(std::move(list));
  }
}

void Fields::set_idle(const std::function<std::string(const Parameter&)>& reason) {
  for (Parameter& parameter : parameters_) parameter.idle = reason(parameter);
}

void Fields::idle_if(bool condition, std::string_view reason,
                     std::initializer_list<std::string_view> names) {
  if (!condition) return;
  for (const std::string_view name : names) {
    const std::string key = full_key(name);
    for (Parameter& parameter : parameters_) {
      if (parameter.key == key || parameter.key.starts_with(key + ".")) parameter.idle = reason;
    }
  }
}

std::optional<std::vector<std::string>> sequence_entries(std::string_view text) {
  text = trimmed(text);
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return std::nullopt;
  std::string_view rest = trimmed(text.substr(1, text.size() - 2));
  std::vector<std::string> entries;
  while (!rest.empty()) {
    auto entry = rest.front() == '"' ? take_quoted(rest) : take_plain(rest);
    if (!entry) return std::nullopt;
    entries.push_back(std::move(*entry));
    if (rest.empty()) break;
    if (rest.front() != ',') return std::nullopt;
    rest = trimmed(rest.substr(1));
    if (rest.empty()) return std::nullopt;
  }
  return entries;
}

std::string sequence_text(const std::vector<std::string>& entries) {
  std::string text = "[";
  for (const std::string& entry : entries) {
    if (text.size() > 1) text += ", ";
    text += quoted_if_needed(entry);
  }
  return text + "]";
}

}  // namespace aims
