// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/sweep_summary.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "bench/tuning/range_key.hpp"
#include "bench/tuning/response_summary.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "core/files/yaml_config.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

using Values = std::vector<double>;  ///< of the ranges' keys; empty: the default setting
using Cases = std::vector<ResponseCase>;

/// The runs of one estimator, by point and sequence.
struct Collected {
  EstimatorSpec estimator;
  std::vector<Values> order;  ///< of points, as they appear
  std::map<Values, std::map<std::size_t, RunScore>> runs;
};

std::size_t index_of(const ResponseCase& on, Cases& sequences) {
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    if (sequences[i].scenario == on.scenario && sequences[i].seed == on.seed) return i;
  }
  sequences.push_back(on);
  return sequences.size() - 1;
}

/// The runs in the order of the sequences; none unless all are there.
std::optional<std::vector<RunScore>> all_runs(const std::map<std::size_t, RunScore>& by_sequence,
                                              std::size_t sequences) {
  if (by_sequence.size() != sequences) return std::nullopt;
  std::vector<RunScore> runs;
  for (const auto& [sequence, run] : by_sequence) runs.push_back(run);
  return runs;
}

bool on_grid(const ParameterRange& range, double value) {
  for (int k = 0; k < range.count; ++k) {
    if (value_at(range, range.count == 1 ? 0.0 : k / double(range.count - 1)) == value) return true;
  }
  return false;
}

/// Where the default values are a point of the grid, one job serves both and is listed once.
void add_default_point(ResponseTable& table) {
  const auto& values = table.defaults;
  if (table.default_runs.empty()) return;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!on_grid(table.ranges[i], values[i])) return;
  }
  if (std::find(table.points.begin(), table.points.end(), values) != table.points.end()) return;
  table.points.push_back(values);
  table.runs.push_back(table.default_runs);
}

/// Where the plain defaults were not run, as by a tuning that has them among its points, those.
void find_default_runs(ResponseTable& table) {
  if (!table.default_runs.empty()) return;
  const auto found = std::find(table.points.begin(), table.points.end(), table.defaults);
  if (found == table.points.end()) return;
  table.default_runs = table.runs[static_cast<std::size_t>(found - table.points.begin())];
}

/// Adds a plan's estimators with their settings in order; one without a label has its name.
void add_planned(const std::vector<std::string>& texts, std::vector<EstimatorSpec>& planned) {
  for (const std::string& text : texts) {
    auto spec = parse_estimator_spec(text);
    if (!spec) continue;
    if (spec->label == label_of(unlabelled_text(*spec))) spec->label = spec->name;
    std::ranges::sort(spec->settings);
    const bool known = std::ranges::any_of(planned, [&](const EstimatorSpec& each) {
      return unlabelled_text(each) == unlabelled_text(*spec);
    });
    if (!known) planned.push_back(std::move(*spec));
  }
}

/// The one estimator of the plans that differs from `spec` in varied values alone; null of none and
/// of several.
const EstimatorSpec* planned_as(const EstimatorSpec& spec, const VariedParameters& varied) {
  const EstimatorSpec* found = nullptr;
  for (const EstimatorSpec& each : varied.planned) {
    if (fixed_text(each, varied.ranges) != fixed_text(spec, varied.ranges)) continue;
    if (found != nullptr) return nullptr;
    found = &each;
  }
  return found;
}

Result<SweepResponse> response_of(const Collected& collected, const VariedParameters& varied,
                                  const Cases& sequences) {
  SweepResponse response;
  response.estimator = text_of(collected.estimator);
  ResponseTable& table = response.table;
  table.ranges = varied.ranges;
  table.cases = sequences;
  auto defaults = default_values(collected.estimator, varied);
  if (!defaults) return tl::unexpected(defaults.error());
  table.defaults = std::move(*defaults);
  for (const Values& values : collected.order) {
    auto runs = all_runs(collected.runs.at(values), sequences.size());
    if (!runs) {
      ++response.incomplete;
    } else if (values.empty()) {
      table.default_runs = std::move(*runs);
    } else {
      table.points.push_back(values);
      table.runs.push_back(std::move(*runs));
    }
  }
  find_default_runs(table);
  add_default_point(table);
  return response;
}

}  // namespace

Result<VariedParameters> varied_in(const MergedSweep& sweep) {
  VariedParameters varied;
  for (const std::string& text : sweep.plans) {
    SweepPlan plan;
    if (auto read = load_config_text(text, "plan.yaml", plan); !read) {
      return tl::unexpected(read.error());
    }
    auto ranges = parse_ranges(plan.params, plan.estimators);
    if (!ranges) return tl::unexpected(ranges.error());
    for (ParameterRange& range : *ranges) {
      const bool known = std::any_of(varied.ranges.begin(), varied.ranges.end(),
                                     [&](const auto& each) { return each.key == range.key; });
      if (!known) varied.ranges.push_back(std::move(range));
    }
    add_planned(plan.estimators, varied.planned);
    if (auto set = set_estimators(plan, varied.base); !set) return tl::unexpected(set.error());
  }
  if (varied.ranges.empty()) return failure("the sweep varies nothing: no range in its plan");
  for (const MergedJob& job : sweep.jobs) {
    if (!job.file.is_object()) continue;
    const Json defaults = value_in(job.file, "defaults", Json::object());
    for (const auto& [key, text] : defaults.items()) {
      const auto value =
          text.is_string() ? number_from<double>(text.get<std::string>()) : std::nullopt;
      if (value) varied.scenario_values.emplace(key, *value);
    }
  }
  return varied;
}

std::optional<PlacedJob> placed_job(const MergedJob& job, const VariedParameters& varied) {
  if (job.is_missing()) return std::nullopt;
  PlacedJob placed;
  placed.estimator.name = value_in(job.file, "estimator", "");
  placed.estimator.label = placed.estimator.name;
  std::map<std::string, std::string> settings;
  const Json all_settings = value_in(job.file, "settings", Json::object());
  for (const auto& [key, value] : all_settings.items()) {
    settings[key] = value.is_string() ? value.get<std::string>() : json_text(value, -1);
  }
  placed.estimator.settings.assign(settings.begin(), settings.end());
  const EstimatorSpec* planned = planned_as(placed.estimator, varied);
  const bool as_planned =
      planned != nullptr && unlabelled_text(*planned) == unlabelled_text(placed.estimator);
  for (const ParameterRange& range : varied.ranges) {
    const auto found = as_planned ? settings.end() : settings.find(range.key);
    if (found == settings.end()) continue;
    const auto value = number_from<double>(found->second);
    if (!value) return std::nullopt;
    placed.values.push_back(*value);
    settings.erase(found);
  }
  if (!placed.values.empty() && placed.values.size() != varied.ranges.size()) return std::nullopt;
  placed.estimator.settings.assign(settings.begin(), settings.end());
  for (const EstimatorSpec& each : varied.planned) {
    if (unlabelled_text(each) == unlabelled_text(placed.estimator)) placed.estimator = each;
  }
  if (planned != nullptr) placed.estimator = *planned;
  const std::string family = value_in(job.file, "family", "");
  placed.on = {job.listed.scenario, family.empty() ? job.listed.scenario : family,
               value_in(job.file, "seed", std::uint64_t{0})};
  auto result = result_in(job.file);
  if (!result) return std::nullopt;
  placed.result = std::move(*result);
  return placed;
}

Result<std::vector<double>> default_values(const EstimatorSpec& estimator,
                                           const VariedParameters& varied) {
  auto config = config_with(estimator, varied.base);
  if (!config) return tl::unexpected(config.error());
  const Fields fields = fields_of(**config);
  std::vector<double> values;
  for (const ParameterRange& range : varied.ranges) {
    if (!range.of_estimator) {
      const auto known = varied.scenario_values.find(range.key);
      values.push_back(known == varied.scenario_values.end() ? range.low : known->second);
      continue;
    }
    const Parameter* parameter = fields.find(range.key);
    if (parameter == nullptr) return failure(unknown_key_message(fields, range.key));
    values.push_back(number_from<double>(parameter->text()).value_or(range.low));
  }
  return values;
}

Result<std::vector<SweepResponse>> sweep_responses(const MergedSweep& sweep,
                                                   const std::string& score) {
  const auto varied = varied_in(sweep);
  if (!varied) return tl::unexpected(varied.error());
  Cases sequences;
  std::vector<std::string> names;
  std::map<std::string, Collected> by_name;
  for (const MergedJob& job : sweep.jobs) {
    const auto found = placed_job(job, *varied);
    if (!found) continue;
    const std::string name = text_of(found->estimator);
    Collected& collected = by_name[name];
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(name);
      collected.estimator = found->estimator;
    }
    if (!collected.runs.contains(found->values)) collected.order.push_back(found->values);
    collected.runs[found->values][index_of(found->on, sequences)] = run_score(found->result, score);
  }
  std::vector<SweepResponse> responses;
  for (const std::string& name : names) {
    auto response = response_of(by_name[name], *varied, sequences);
    if (!response) return tl::unexpected(response.error());
    responses.push_back(std::move(*response));
  }
  return responses;
}

std::string unstarted_text(const MergedSweep& sweep) {
  std::map<std::string, bool> done;
  for (const MergedJob& job : sweep.jobs) {
    bool& any = done[job.listed.scenario + " seed " + job.listed.seed];
    any = any || !job.is_missing();
  }
  std::vector<std::string> open;
  for (const auto& [sequence, any] : done) {
    if (!any) open.push_back(sequence);
  }
  if (open.empty()) return "";
  return fmt::format("{} of {} sequences are left out, since no job of them is done: {}",
                     open.size(), done.size(), fmt::join(open, ", "));
}

Result<void> write_sweep_summary(const MergedSweep& sweep, const Objective& objective,
                                 const fs::path& folder) {
  const auto responses = sweep_responses(sweep, objective.score);
  if (!responses) return tl::unexpected(responses.error());
  std::string text = "# Sweep\n";
  text += fmt::format("\n{} of {} jobs done.\n", sweep.count("done"), sweep.jobs.size());
  if (const std::string open = unstarted_text(sweep); !open.empty()) text += open + ".\n";
  for (const SweepResponse& response : *responses) {
    text += fmt::format("\n## `{}`\n\n", response.estimator);
    if (response.incomplete > 0) {
      text += fmt::format("{} points are left out: not all of their sequences are done.\n\n",
                          response.incomplete);
    }
    text += response_markdown(response.table, objective_for(objective, response.table));
  }
  return write_report({.name = "sweep", .markdown = text}, folder);
}

}  // namespace aims
