// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/sensitivity.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "estimator/python/python_estimator.hpp"

namespace aims {
namespace {

constexpr const char* kAte = "ate_yaw_m";  ///< the headline

/// The numbers of the text times `factor`: "[0.1, 0.2]" times 2 is "[0.2,0.4]".
std::string scaled_text(const Parameter& parameter, double factor) {
  const auto scaled = [&](const std::string& number) {
    const double value = factor * std::stod(number);
    return parameter.kind == ParameterKind::kInteger ? fmt::format("{}", std::llround(value))
                                                     : fmt::format("{:.9g}", value);
  };
  auto entries = sequence_entries(parameter.text());
  if (!entries) return scaled(parameter.text());
  std::ranges::transform(*entries, entries->begin(), scaled);
  return fmt::format("[{}]", fmt::join(*entries, ","));
}

bool holds_numbers(const Parameter& parameter) {
  return is_number(parameter) || parameter.kind == ParameterKind::kVector ||
         parameter.kind == ParameterKind::kNumbers;
}

/// Whether it has numbers that can have an effect on the estimate.
bool is_varied(const Parameter& parameter) {
  return parameter.idle.empty() && !is_operational(parameter.key) && holds_numbers(parameter);
}

std::string variant_label(const std::string& key, double factor) {
  std::string label = fmt::format("{}_times_{:g}", key, factor);
  std::replace(label.begin(), label.end(), '.', '_');
  return label;
}

/// The ATE of all sequences on which both estimators have one.
ScorePairs pooled_pairs(const Suite& suite, const std::string& reference,
                        const std::string& other) {
  ScorePairs all;
  for (const SuiteCase& each : suite.cases) {
    const ScorePairs pairs = paired({each.runs, reference}, {each.runs, other}, kAte);
    all.reference.insert(all.reference.end(), pairs.reference.begin(), pairs.reference.end());
    all.value.insert(all.value.end(), pairs.value.begin(), pairs.value.end());
  }
  return all;
}

void count_successes(const Suite& suite, const std::string& reference, const std::string& other,
                     SensitivityCell& cell) {
  SuccessDifferences differences;
  for (const SuiteCase& each : suite.cases) {
    for (const RunRecord& run : each.runs) {
      const auto before = succeeds(run, reference);
      const auto after = succeeds(run, other);
      if (before && after) differences.add(run.seed, *before, *after);
    }
  }
  const SuccessTest test = differences.test();
  cell.lost = static_cast<int>(test.only_first);
  cell.won = static_cast<int>(test.only_second);
  cell.success_p = test.by_seed.p;
}

SensitivityCell cell_of(const Suite& suite, const std::string& estimator,
                        const SettingVariant& variant) {
  SensitivityCell cell;
  cell.factor = variant.factor;
  if (!variant.spec) return cell;
  const ScorePairs pairs = pooled_pairs(suite, estimator, variant.spec->label);
  cell.pairs = pairs.value.size();
  const auto reference = median(pairs.reference);
  if (reference && *reference > 0.0) cell.ratio = *median(pairs.value) / *reference;
  count_successes(suite, estimator, variant.spec->label, cell);
  return cell;
}

}  // namespace

std::optional<double> SensitivityRow::largest_change() const {
  std::optional<double> largest;
  for (const SensitivityCell& cell : cells) {
    if (!cell.ratio) continue;
    largest = std::max(largest.value_or(0.0), std::abs(*cell.ratio - 1.0));
  }
  return largest;
}

int SensitivityRow::most_lost() const {
  int most = 0;
  for (const SensitivityCell& cell : cells) most = std::max(most, cell.lost - cell.won);
  return most;
}

Result<std::vector<SettingVariant>> setting_variants(const std::string& text,
                                                     const std::vector<double>& factors,
                                                     const EstimatorConfigs& base) {
  const auto spec = parse_estimator_spec(text);
  if (!spec) return tl::unexpected(spec.error());
  auto config = config_with(*spec, base);
  if (!config) return tl::unexpected(config.error());
  const Fields fields = fields_of(**config);
  std::vector<SettingVariant> variants;
  for (const Parameter& parameter : fields.parameters()) {
    if (!is_varied(parameter)) continue;
    for (const double factor : factors) {
      EstimatorSpec changed = *spec;
      changed.label = variant_label(parameter.key, factor);
      changed.settings.emplace_back(parameter.key, scaled_text(parameter, factor));
      SettingVariant variant{parameter.key, parameter.text(), factor, std::nullopt};
      const bool same = changed.settings.back().second == scaled_text(parameter, 1.0);
      if (!same && config_with(changed, base)) variant.spec = std::move(changed);
      variants.push_back(std::move(variant));
    }
  }
  return variants;
}

Result<std::vector<SettingVariant>> set_setting_variants(const SensitivityOptions& options,
                                                         std::vector<ScenarioFile>& scenarios) {
  std::vector<SettingVariant> variants;
  for (ScenarioFile& each : scenarios) {
    if (!each.scenario) continue;
    auto own = setting_variants(options.estimator, options.factors, each.scenario->estimators);
    if (!own) return tl::unexpected(own.error());
    each.scenario->run = {options.estimator};
    for (const SettingVariant& variant : *own) {
      if (variant.spec) each.scenario->run.push_back(text_of(*variant.spec));
    }
    if (auto valid = check_estimator_specs(each.scenario->run); !valid) {
      return tl::unexpected(valid.error());
    }
    variants = std::move(*own);
  }
  return variants;
}

SettingSensitivity sensitivity_of(const Suite& suite, const std::string& estimator,
                                  const std::vector<SettingVariant>& variants) {
  SettingSensitivity sensitivity;
  sensitivity.estimator = estimator;
  const ScorePairs own = pooled_pairs(suite, estimator, estimator);
  sensitivity.sequences = own.value.size();
  sensitivity.median_ate = median(own.value);
  for (const SettingVariant& variant : variants) {
    if (sensitivity.rows.empty() || sensitivity.rows.back().key != variant.key) {
      sensitivity.rows.push_back({variant.key, variant.value, {}});
    }
    sensitivity.rows.back().cells.push_back(cell_of(suite, estimator, variant));
  }
  std::ranges::stable_sort(sensitivity.rows, std::greater<>(), [](const SensitivityRow& row) {
    return std::pair(row.most_lost(), row.largest_change().value_or(-1.0));
  });
  return sensitivity;
}

}  // namespace aims
