// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/range_key.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "estimator/python/python_estimator.hpp"
#include "estimator/registry.hpp"

namespace aims {
namespace {

constexpr std::string_view kEstimators = "estimators.";
constexpr std::string_view kScenario = "scenario.";

/// What decides a run's numbers, without the estimator: keys of a scenario that a range may have.
struct Deciding {
  SimulationConfig simulation;
  ScoreConfig scoring;
};

void describe(Fields& fields, Deciding& deciding) {
  describe(fields, deciding.simulation);
  fields.group("scoring", deciding.scoring);
}

/// The keys of all estimators, relative to each.
Fields estimator_fields(EstimatorConfigs& configs) {
  Fields fields;
  for (const std::string& name : estimator_names()) describe(fields, *configs.find(name));
  return fields;
}

bool estimator_has(std::string_view key) {
  EstimatorConfigs configs;
  return estimator_fields(configs).find(key) != nullptr;
}

bool scenario_has(std::string_view key) {
  Deciding config;
  return fields_of(config).find(key) != nullptr;
}

/// Why `base` has no such key to be varied.
std::string absence(const ParameterRange& range, const Scenario& base) {
  Scenario scenario = base;
  if (!range.of_estimator && fields_of(scenario).find(full_key(range)) != nullptr) {
    return fmt::format(
        "range '{}': '{}' decides no number of a run; expected a key of the estimator, the "
        "simulation or the scoring{}",
        text_of(range), range.key, range.key == "seed" ? "; seeds are listed by 'seeds'" : "");
  }
  Fields written = estimator_fields(scenario.estimators);
  Deciding deciding{scenario.simulation, scenario.scoring};
  describe(written, deciding);
  return fmt::format("range '{}': {}", text_of(range), unknown_key_message(written, range.key));
}

Result<void> check_range(const ParameterRange& range, const Parameter& parameter) {
  if (!is_number(parameter)) {
    return failure(fmt::format("range '{}': '{}' is {}, and only numbers have ranges",
                               text_of(range), range.key, parameter.expected));
  }
  const Range& allowed = parameter.spec.range;
  if (allowed.contains(range.low) && allowed.contains(range.high)) return {};
  return failure(fmt::format("range '{}': expected {}{}", text_of(range), parameter.expected,
                             parameter.spec.unit.empty() || parameter.spec.unit == "-"
                                 ? ""
                                 : fmt::format(" [{}]", parameter.spec.unit)));
}

/// Error for a range that the estimator of `spec` cannot be varied over.
Result<void> check_in_estimator(const ParameterRange& range, const Scenario& base,
                                const EstimatorSpec& spec) {
  const bool in_python = is_python_name(spec.name);
  const std::string& name = in_python ? spec.label : spec.name;
  if (!range.estimator.empty() && range.estimator != name) {
    return failure(fmt::format("range '{}': a key of {}, but {} is varied", text_of(range),
                               range.estimator, name));
  }
  const auto config = config_with(spec, base.estimators);
  if (!config) return tl::unexpected(config.error());
  const Fields fields = fields_of(**config);
  const Parameter* parameter = fields.find(range.key);
  if (parameter == nullptr && in_python) {
    EstimatorSpec with_key = spec;
    with_key.settings.emplace_back(range.key, "0");
    return failure(fmt::format("range '{}': {}", text_of(range),
                               config_with(with_key, base.estimators).error().message));
  }
  if (parameter == nullptr && estimator_has(range.key)) {
    return failure(
        fmt::format("range '{}': {} has no key '{}'", text_of(range), spec.name, range.key));
  }
  if (parameter == nullptr) return failure(absence(range, base));
  if (parameter->idle.empty()) return check_range(range, *parameter);
  return failure(fmt::format("range '{}': {} has no effect on {}: {}", text_of(range), range.key,
                             text_of(spec), parameter->idle));
}

}  // namespace

Result<RangeKey> range_key(std::string_view given, bool in_python) {
  const bool for_scenario = given.starts_with(kScenario);
  const std::string_view key = for_scenario ? given.substr(kScenario.size()) : given;
  if (key.starts_with(kEstimators)) {
    const std::string_view rest = key.substr(kEstimators.size());
    const std::size_t dot = std::min(rest.find('.'), rest.size() - 1);
    const std::string name(rest.substr(0, dot));
    return RangeKey{std::string(rest.substr(dot + 1)), true, name == "*" ? "" : name};
  }
  const bool of_both = estimator_has(key) && scenario_has(key);
  if (of_both && !for_scenario) {
    return failure(
        fmt::format("key '{0}': the estimator and the simulation have it; expected "
                    "'{1}*.{0}' or '{2}{0}'",
                    key, kEstimators, kScenario));
  }
  if (of_both) return RangeKey{std::string(given), false};
  const bool of_estimator = estimator_has(key) || (in_python && !scenario_has(key));
  return RangeKey{std::string(key), !for_scenario && of_estimator};
}

std::string full_key(const ParameterRange& range) {
  if (range.of_estimator) return std::string(kEstimators) + "*." + range.key;
  return range.key.starts_with(kScenario) ? range.key.substr(kScenario.size()) : range.key;
}

Range allowed_values(const ParameterRange& range) {
  EstimatorConfigs configs;
  Deciding deciding;
  const Fields fields = range.of_estimator ? estimator_fields(configs) : fields_of(deciding);
  const Parameter* parameter = fields.find(range.of_estimator ? range.key : full_key(range));
  return parameter == nullptr ? any() : parameter->spec.range;
}

Result<std::vector<ParameterRange>> parse_ranges(std::span<const std::string> texts,
                                                 std::span<const std::string> estimators) {
  const bool in_python = std::ranges::any_of(estimators, [](const std::string& text) {
    const auto spec = parse_estimator_spec(text);
    return spec && is_python_name(spec->name);
  });
  std::vector<ParameterRange> ranges;
  for (const std::string& text : texts) {
    auto range = parse_range(text);
    if (!range) return tl::unexpected(range.error());
    auto key = range_key(range->key, in_python);
    if (!key) return failure(fmt::format("range '{}': {}", text, key.error().message));
    range->key = std::move(key->name);
    range->of_estimator = key->of_estimator;
    range->estimator = std::move(key->estimator);
    ranges.push_back(std::move(*range));
  }
  return ranges;
}

Result<void> check_ranges(std::span<const ParameterRange> ranges, const Scenario& base,
                          std::span<const EstimatorSpec> estimators) {
  Deciding deciding{base.simulation, base.scoring};
  const Fields fields = fields_of(deciding);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const ParameterRange& range = ranges[i];
    if (range.of_estimator) {
      for (const EstimatorSpec& spec : estimators) {
        if (auto right = check_in_estimator(range, base, spec); !right) return right;
      }
    } else {
      const Parameter* parameter = fields.find(full_key(range));
      if (parameter == nullptr) return failure(absence(range, base));
      if (auto right = check_range(range, *parameter); !right) return right;
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (full_key(ranges[k]) != full_key(range)) continue;
      return failure(fmt::format("range '{}': a second range of '{}'", text_of(range), range.key));
    }
  }
  return {};
}

namespace {

constexpr double kEdge = 0.02;  ///< this near to an end, in widths of the range

constexpr double kAtEdge = 1e-9;  ///< likewise; farther off a value is near it

/// " (at the lower edge ...)", or nothing.
std::string edge_text(const ParameterRange& range, double value) {
  const double fraction = fraction_of(range, value);
  if (fraction < -kEdge || fraction > 1.0 + kEdge) return "";  // a default beyond the range
  const bool lower = fraction <= kEdge;
  if (!lower && fraction < 1.0 - kEdge) return "";
  const Range allowed = allowed_values(range);
  const bool final = lower ? range.low <= allowed.min : range.high >= allowed.max;
  const bool at = lower ? fraction <= kAtEdge : fraction >= 1.0 - kAtEdge;
  const std::string beyond =
      final ? fmt::format("values {} {} are not allowed", lower ? "below" : "above",
                          lower ? range.low : range.high)
            : "the optimum may lie outside";
  return fmt::format(" ({} the {} edge of its range {} to {}: {})", at ? "at" : "near",
                     lower ? "lower" : "upper", range.low, range.high, beyond);
}

}  // namespace

std::string values_text(std::span<const ParameterRange> ranges, std::span<const double> defaults,
                        std::span<const double> values, const std::vector<bool>& without_effect) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (i < without_effect.size() && without_effect[i]) {
      texts.push_back(
          fmt::format("{} {:.3g} as by default (no effect measured)", ranges[i].key, defaults[i]));
      continue;
    }
    const std::string value = fmt::format("{:.3g}", values[i]);
    const std::string before = fmt::format("{:.3g}", defaults[i]);
    const std::string beside = value == before ? " as by default" : " instead of " + before;
    texts.push_back(ranges[i].key + " " + value + beside + edge_text(ranges[i], values[i]));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace aims
