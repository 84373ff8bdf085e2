// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Interval of allowed numbers.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_included = true;
  bool max_included = true;

  bool contains(double value) const;
  std::string text() const;  ///< e.g. "in [0, 1)"; empty when unbounded
};

/// Least of the values that must not be zero: its square and their inverses are still numbers.
inline constexpr double kLeastPositive = 1e-12;

/// For what is no number. Every number needs two finite bounds (a test looks at each of them): ones
/// that no user meets, but within which no conversion or product overflows.
constexpr Range any() { return {}; }
constexpr Range up_to(double max) { return {.min = 0.0, .max = max}; }
constexpr Range positive_up_to(double max) { return {.min = kLeastPositive, .max = max}; }
constexpr Range within(double magnitude) { return {.min = -magnitude, .max = magnitude}; }
constexpr Range in_range(double min, double max) { return {.min = min, .max = max}; }
constexpr Range in_half_open(double min, double max) {
  return {.min = min, .max = max, .max_included = false};
}

/// Documentation of a parameter.
struct Spec {
  std::string unit = {};     ///< e.g. "m/s", "-" when dimensionless
  Range range = {};          ///< for numbers and each entry of a vector
  std::string meaning = {};  ///< one sentence
  std::string source = {};   ///< equation, datasheet or document; may be empty
};

enum class ParameterKind { kNumber, kInteger, kFlag, kText, kChoice, kVector, kNumbers, kTexts };

/// One scalar (or short vector) of a configuration, with its documentation.
struct Parameter {
  std::string key;  ///< full dotted key, e.g. "estimators.aims.degeneracy.eta"
  ParameterKind kind;
  Spec spec;
  std::string expected;               ///< e.g. "a number in [0, 1)", "one of point, rolling"
  std::function<std::string()> text;  ///< current value; of a sequence: "[a, b]"
  std::function<bool(std::string_view)> assign;  ///< false: not what was expected
  std::string idle = {};  ///< why the value has no effect now, e.g. "legs.enabled is false"
  std::vector<std::string> options = {};  ///< of a choice: its names
};

/// Whether the parameter is one number, whole or not; false for a vector.
bool is_number(const Parameter& parameter);

/// Whether the parameter holds several scalars, written "[a, b]".
bool is_sequence(const Parameter& parameter);

/// A list of groups inside a configuration, e.g. the points of a route.
struct ListField {
  std::string key;
  std::function<std::size_t()> size;
  std::function<void(std::size_t)> resize;
  std::string meaning;
};

/// The field list of a configuration: one `describe(Fields&, Config&)` per struct drives loading,
/// dumping, `--set`, validation, documentation and sweeps. It points into the configuration and
/// must not outlive it; collect it again after resizing a list.
class Fields {
 public:
  void number(std::string_view name, double& value, Spec spec);
  void integer(std::string_view name, int& value, Spec spec);
  void flag(std::string_view name, bool& value, Spec spec);
  void text(std::string_view name, std::string& value, Spec spec);
  void texts(std::string_view name, std::vector<std::string>& value, Spec spec);
  /// Any number of numbers, each within the range.
  void numbers(std::string_view name, std::vector<double>& value, Spec spec);
  void vector(std::string_view name, Eigen::Vector3d& value, Spec spec);
  void vector(std::string_view name, Eigen::Vector2d& value, Spec spec);

  /// One of a few named values, e.g. {{"point", FootModel::kPoint}, {"rolling", ...}}.
  template <class Enum>
  void choice(std::string_view name, Enum& value, std::vector<std::pair<std::string, Enum>> options,
              Spec spec);

  /// A nested configuration with its own `describe`. With a switch `enabled` that is false, its
  /// other parameters are idle.
  template <class Config>
  void group(std::string_view name, Config& config);

  /// A list of nested configurations; entry i has the keys `name.i.*`.
  template <class Config>
  void list(std::string_view name, std::vector<Config>& items, std::string meaning);

  /// The fields of another configuration as the group `name`; reasons why they are idle stay.
  void group_of(std::string_view name, Fields fields);

  /// Marks each parameter as idle for the reason given; an empty one: it has an effect.
  void set_idle(const std::function<std::string(const Parameter&)>& reason);

  /// With `condition`, marks the parameters named (a group: all below it) as idle for that reason.
  /// A later reason replaces an earlier one: state the narrow reasons first.
  void idle_if(bool condition, std::string_view reason,
               std::initializer_list<std::string_view> names);

  const std::vector<Parameter>& parameters() const& { return parameters_; }
  const std::vector<ListField>& lists() const& { return lists_; }
  // By value from a temporary, so that `for (... : fields_of(config).parameters())` is safe.
  std::vector<Parameter> parameters() && { return std::move(parameters_); }
  std::vector<ListField> lists() && { return std::move(lists_); }

  /// The parameter with that full key, or nullptr.
  const Parameter* find(std::string_view key) const;

  /// The parameters of a key in which a segment `*` stands for any name.
  std::vector<const Parameter*> matching(std::string_view key) const;

 private:
  std::string full_key(std::string_view name) const;
  void idle_below_switch();
  template <class Number>
  void add_number(std::string_view name, ParameterKind kind, Number& value, Spec spec,
                  std::string_view what);
  template <class Vector>
  void add_vector(std::string_view name, Vector& value, Spec spec, std::string_view what);
  void add(std::string_view name, ParameterKind kind, Spec spec, std::string expected,
           std::function<std::string()> text, std::function<bool(std::string_view)> assign);

  std::string prefix_;
  std::vector<Parameter> parameters_;
  std::vector<ListField> lists_;
};

/// The field list of `config`.
template <class Config>
Fields fields_of(Config& config) {
  Fields fields;
  describe(fields, config);
  return fields;
}

/// Whether the key, or with `prefix` the group, has the names of `pattern`, in which a segment `*`
/// stands for any name.
bool key_matches(std::string_view pattern, std::string_view key, bool prefix = false);

/// Sets `key` to `value` (text as in YAML); a segment `*` sets every parameter that matches. Errors
/// name the key, what was expected, a near match.
Result<void> assign(const Fields& fields, std::string_view key, std::string_view value);

/// A key that was set, for the check that it has an effect.
struct AssignedKey {
  std::string key;         ///< as written, may hold `*`
  std::string place;       ///< "file:line:column: ", "--set key=value: " or empty
  bool from_file = false;  ///< in a YAML file
};

/// Error for a key that has no effect in the final configuration, with the reason. Of a key with
/// `*`, one parameter with an effect is enough.
Result<void> check_effect(const Fields& fields, std::span<const AssignedKey> assigned);

/// Entries of the text "[a, b]"; an entry in double quotes may hold anything (\" and \\ escaped).
/// Empty when it is not such a text.
std::optional<std::vector<std::string>> sequence_entries(std::string_view text);

/// The text "[a, b]" of entries, in double quotes where needed; undone by `sequence_entries`.
std::string sequence_text(const std::vector<std::string>& entries);

/// "; did you mean 'a'?" for a value that a choice does not have; empty when none is near.
std::string option_proposal(const Parameter& parameter, std::string_view value);

/// The candidate closest to `word` by edit distance, or empty when none is near.
std::string near_match(std::string_view word, const std::vector<std::string>& candidates);

/// "unknown key 'a.b'; did you mean 'a.c'?" for a key that `fields` does not have. Proposes, in
/// this order: a similar name in the same group, the same name in another group, a similar key.
std::string unknown_key_message(const Fields& fields, std::string_view key);

template <class Enum>
void Fields::choice(std::string_view name, Enum& value,
                    std::vector<std::pair<std::string, Enum>> options, Spec spec) {
  std::string expected = "one of";
  for (const auto& [label, option] : options) expected += " " + label + ",";
  expected.pop_back();
  auto text = [&value, options] {
    for (const auto& [label, option] : options) {
      if (option == value) return label;
    }
    return std::string();
  };
  auto assign = [&value, options](std::string_view given) {
    for (const auto& [label, option] : options) {
      if (label == given) {
        value = option;
        return true;
      }
    }
    return false;
  };
  add(name, ParameterKind::kChoice, std::move(spec), std::move(expected), std::move(text),
      std::move(assign));
  for (const auto& [label, option] : options) parameters_.back().options.push_back(label);
}

template <class Config>
void Fields::group(std::string_view name, Config& config) {
  const std::string outer = prefix_;
  prefix_ = full_key(name);
  describe(*this, config);
  idle_below_switch();
  prefix_ = outer;
}

template <class Config>
void Fields::list(std::string_view name, std::vector<Config>& items, std::string meaning) {
  lists_.push_back({full_key(name), [&items] { return items.size(); },
                    [&items](std::size_t size) { items.resize(size); }, std::move(meaning)});
  const std::string outer = prefix_;
  for (std::size_t i = 0; i < items.size(); ++i) {
    prefix_ = outer;
    prefix_ = full_key(std::string(name) + "." + std::to_string(i));
    describe(*this, items[i]);
  }
  prefix_ = outer;
}

}  // namespace aims
