// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/ablation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace aims {
namespace {

bool is_flag(const Parameter& parameter) { return parameter.kind == ParameterKind::kFlag; }

/// "ground_constraint" of "ground_constraint.enabled", "lidar_leave_out_mixed" of
/// "lidar.leave_out_mixed".
std::string part_of(std::string key) {
  constexpr std::string_view kEnabled = ".enabled";
  if (key.ends_with(kEnabled)) key.resize(key.size() - kEnabled.size());
  std::replace(key.begin(), key.end(), '.', '_');
  return key;
}

/// The estimator with that flag turned over; error when another of its settings then has no effect.
Result<std::string> turned_over(const EstimatorSpec& spec, const Parameter& flag,
                                const EstimatorConfigs& base) {
  const bool on = flag.text() == "true";
  EstimatorSpec variant = spec;
  variant.label = (on ? "no_" : "with_") + part_of(flag.key);
  variant.settings.emplace_back(flag.key, on ? "false" : "true");
  if (auto works = config_with(variant, base); !works) return tl::unexpected(works.error());
  return text_of(variant);
}

/// The estimator without each of its parts that can be switched off alone.
std::vector<std::string> without_each_part(const EstimatorSpec& spec, const Fields& fields,
                                           const EstimatorConfigs& base) {
  std::vector<std::string> specs;
  for (const Parameter& parameter : fields.parameters()) {
    if (!is_flag(parameter) || !parameter.idle.empty() || parameter.text() != "true") continue;
    if (auto variant = turned_over(spec, parameter, base)) specs.push_back(std::move(*variant));
  }
  return specs;
}

AblationRow row_of(const SuiteCase& each, const std::string& complete, const std::string& label) {
  AblationRow row;
  row.label = label;
  const SuccessRate rate = success_rate(each.runs, label);
  row.runs = rate.runs;
  row.successes = rate.count;
  row.strict = success_rate(each.runs, label, kStrictSuccessKey);
  row.success_test = success_test({each.runs, complete}, {each.runs, label});
  for (std::size_t i = 0; i < kAblationCount; ++i) {
    row.cells[i] =
        statistics_of(paired({each.runs, complete}, {each.runs, label}, ablation_scores()[i].key));
  }
  return row;
}

AblationCase case_of(const SuiteCase& each, const std::string& complete) {
  AblationCase result{each.scenario.name, {}};
  if (each.runs.empty()) return result;
  for (const std::string& label : labels_of(each.scenario.run)) {
    result.rows.push_back(row_of(each, complete, label));
  }
  return result;
}

/// The settings that the label stands for in any case.
std::string changes_of(const Suite& suite, const std::string& label) {
  for (const SuiteCase& each : suite.cases) {
    for (const std::string& text : each.scenario.run) {
      const auto spec = parse_estimator_spec(text);
      if (!spec || spec->label != label) continue;
      return unlabelled_text(*spec);
    }
  }
  return label;
}

AblationEffect effect_of(const Ablation& ablation, const Suite& suite, const std::string& label) {
  AblationEffect effect{.label = label, .changes = changes_of(suite, label)};
  constexpr std::size_t kAte = 0;  // the first headline score
  for (const AblationCase& each : ablation.cases) {
    for (const AblationRow& row : each.rows) {
      if (row.label != label) continue;
      effect.runs += row.runs;
      effect.successes += row.successes;
      effect.compared += row.cells[kAte].count;
    }
  }
  for (std::size_t i = 0; i < kAblationCount; ++i) {
    double logarithms = 0.0;
    int count = 0;
    for (const AblationCase& each : ablation.cases) {
      for (const AblationRow& row : each.rows) {
        const auto& ratio = row.cells[i].ratio;
        if (row.label != label || !ratio || !(*ratio > 0.0)) continue;
        logarithms += std::log(*ratio);
        ++count;
        if (i != kAte || (effect.worst_ratio && *effect.worst_ratio >= *ratio)) continue;
        effect.worst_ratio = ratio;
        effect.worst_scenario = each.scenario;
      }
    }
    if (count > 0) effect.ratios[i] = std::exp(logarithms / count);
  }
  return effect;
}

}  // namespace

const std::array<Score, kAblationCount>& ablation_scores() {
  static const std::array<Score, kAblationCount> scores = [] {
    std::array<Score, kAblationCount> all;
    std::ranges::copy(headline_scores(), all.begin());
    all.back() = score_at("weak_axis.all.nees");
    all.back().key = "weak_axis.all.nees";
    return all;
  }();
  return scores;
}

Result<std::vector<std::string>> ablation_specs(const std::string& text,
                                                const std::vector<std::string>& groups,
                                                const EstimatorConfigs& base) {
  const auto spec = parse_estimator_spec(text);
  if (!spec) return tl::unexpected(spec.error());
  auto config = config_with(*spec, base);
  if (!config) return tl::unexpected(config.error());
  const Fields fields = fields_of(**config);
  std::vector<std::string> specs = {text};
  if (groups.empty()) {
    const auto variants = without_each_part(*spec, fields, base);
    specs.insert(specs.end(), variants.begin(), variants.end());
  }
  for (const std::string& group : groups) {
    const std::size_t before = specs.size();
    for (const Parameter& parameter : fields.parameters()) {
      if (!is_flag(parameter) || !parameter.key.starts_with(group + ".")) continue;
      if (!parameter.idle.empty()) continue;
      auto variant = turned_over(*spec, parameter, base);
      if (!variant) return tl::unexpected(variant.error());
      specs.push_back(std::move(*variant));
    }
    if (specs.size() > before) continue;
    return failure(fmt::format("{}: {} has no flag to turn over that has an effect", group, text));
  }
  return specs;
}

Ablation ablation_of(const Suite& suite, const std::string& complete) {
  Ablation ablation;
  ablation.complete = complete;
  std::vector<std::string> labels = {complete};
  for (const SuiteCase& each : suite.cases) {
    ablation.cases.push_back(case_of(each, complete));
    for (const AblationRow& row : ablation.cases.back().rows) {
      if (std::find(labels.begin(), labels.end(), row.label) == labels.end()) {
        labels.push_back(row.label);
      }
    }
  }
  for (const std::string& label : labels) {
    ablation.effects.push_back(effect_of(ablation, suite, label));
  }
  return ablation;
}

Result<void> set_variants(const AblationOptions& options, std::vector<ScenarioFile>& scenarios) {
  for (ScenarioFile& each : scenarios) {
    if (!each.scenario) continue;
    auto specs = ablation_specs(options.estimator, options.groups, each.scenario->estimators);
    if (!specs) return tl::unexpected(specs.error());
    specs->insert(specs->end(), options.baselines.begin(), options.baselines.end());
    if (auto valid = check_estimator_specs(*specs); !valid) return valid;
    each.scenario->run = std::move(*specs);
  }
  return {};
}

}  // namespace aims
