// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/estimator_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "estimator/registry.hpp"

namespace aims {
namespace {

bool allowed_in_label(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

std::vector<std::string> registered() {
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : estimator_registry()) names.emplace_back(entry.name);
  return names;
}

bool is_registered(std::string_view name) {
  const auto names = registered();
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The text split at each '+' before a setting; a '+' inside a number ("1e+3") does not split.
std::vector<std::string> pieces_of(std::string_view text) {
  std::vector<std::string> pieces;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('+', begin), text.size());
    const std::string piece(text.substr(begin, end - begin));
    const bool setting = piece.find('=') != std::string::npos;
    if (pieces.empty() || setting || pieces.size() == 1) {
      pieces.push_back(piece);
    } else {
      pieces.back() += "+" + piece;
    }
    begin = end + 1;
  }
  return pieces;
}

/// A label made of the name and its settings.
std::string made_label(const EstimatorSpec& spec) {
  std::string label = spec.name;
  for (const auto& [key, value] : spec.settings) label += "-" + key + "-" + value;
  std::replace_if(
      label.begin(), label.end(), [](char c) { return !allowed_in_label(c); }, '_');
  return label;
}

/// The parts of the text, unchecked.
EstimatorSpec split(std::string_view text) {
  const std::vector<std::string> pieces = pieces_of(text);
  EstimatorSpec spec;
  const std::size_t equals = pieces.front().find('=');
  spec.name = equals == std::string::npos ? pieces.front() : pieces.front().substr(equals + 1);
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const std::size_t at = pieces[i].find('=');
    const bool has_value = at != std::string::npos;
    spec.settings.emplace_back(pieces[i].substr(0, at), has_value ? pieces[i].substr(at + 1) : "");
  }
  spec.label = equals == std::string::npos ? made_label(spec) : pieces.front().substr(0, equals);
  return spec;
}

Result<void> check_name(const EstimatorSpec& spec) {
  if (is_registered(spec.name)) return {};
  const auto known = registered();
  const std::string near = near_match(spec.name, known);
  return failure(fmt::format("no estimator '{}'; expected one of {}{}", spec.name,
                             fmt::join(known, ", "),
                             near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

Result<void> check_label(const EstimatorSpec& spec, std::string_view text) {
  if (spec.label.empty() || !std::all_of(spec.label.begin(), spec.label.end(), allowed_in_label)) {
    return failure(
        fmt::format("'{}': the label '{}' has characters other than letters, digits, - and _", text,
                    spec.label));
  }
  const bool itself = spec.label == spec.name && spec.settings.empty();
  if (itself || !is_registered(spec.label)) return {};
  return failure(
      fmt::format("'{}': the label '{}' is the name of another estimator; choose another label",
                  text, spec.label));
}

}  // namespace

Result<EstimatorSpec> parse_estimator_spec(std::string_view text) {
  EstimatorSpec spec = split(text);
  if (auto known = check_name(spec); !known) return tl::unexpected(known.error());
  if (auto fits = check_label(spec, text); !fits) return tl::unexpected(fits.error());
  for (const auto& [key, value] : spec.settings) {
    if (!key.empty() && !value.empty()) continue;
    return failure(fmt::format("'{}': expected key=value after each '+'", text));
  }
  if (auto config = config_with(spec, {}); !config) {
    return failure(fmt::format("'{}': {}", text, config.error().message));
  }
  return spec;
}

std::string text_of(const EstimatorSpec& spec) {
  return spec.label == spec.name ? unlabelled_text(spec) : spec.label + "=" + unlabelled_text(spec);
}

std::string unlabelled_text(const EstimatorSpec& spec) {
  std::string text = spec.name;
  for (const auto& [key, value] : spec.settings) text += fmt::format("+{}={}", key, value);
  return text;
}

Result<EstimatorConfig> config_with(const EstimatorSpec& spec, const EstimatorConfig& base) {
  EstimatorConfig config = base;
  const Fields fields = fields_of(config);
  for (const auto& [key, value] : spec.settings) {
    if (auto done = assign(fields, key, value); !done) return tl::unexpected(done.error());
  }
  return config;
}

std::string label_of(std::string_view spec) { return split(spec).label; }

std::vector<std::string> labels_of(std::span<const std::string> specs) {
  std::vector<std::string> labels;
  for (const std::string& spec : specs) labels.push_back(label_of(spec));
  return labels;
}

Result<void> check_estimator_specs(std::span<const std::string> specs) {
  std::set<std::string> labels;
  for (const std::string& text : specs) {
    const auto spec = parse_estimator_spec(text);
    if (!spec) return tl::unexpected(spec.error());
    if (labels.insert(spec->label).second) continue;
    return failure(fmt::format("'{}': the label '{}' is used twice", text, spec->label));
  }
  return {};
}

std::string estimators_setting(std::span<const std::string> specs) {
  return "estimators=" + sequence_text({specs.begin(), specs.end()});
}

std::vector<std::string> joined_specs(std::span<const std::string> pieces) {
  std::vector<std::string> specs;
  bool open = false;
  for (const std::string& piece : pieces) {
    if (open) {
      specs.back() += "," + piece;
    } else {
      specs.push_back(piece);
    }
    const std::string& last = specs.back();
    open = std::count(last.begin(), last.end(), '[') > std::count(last.begin(), last.end(), ']');
  }
  return specs;
}

}  // namespace aims
