// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/tune_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "bench/run/code_version.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/tuning/response_summary.hpp"
#include "bench/tuning/tune_verdict.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/csv.hpp"
#include "core/text.hpp"
#include "estimator/python/python_estimator.hpp"

namespace aims {
namespace {

/// The cases of each table on which its points are compared.
std::vector<std::vector<std::size_t>> common_cases_of(const std::vector<ResponseTable>& tables) {
  std::vector<std::vector<std::size_t>> cases;
  for (const ResponseTable& table : tables) cases.push_back(cases_of(table, ""));
  return cases;
}

/// The best objective so far after each generation, a few to a line.
std::string history_markdown(const TuneResult& result) {
  const ResponseTable& table = result.tables.front();
  const Objective& objective = result.task.plan.objectives.front();
  const auto all = cases_of(table, "");
  std::vector<std::string> history;
  std::optional<double> least;
  for (std::size_t k = 0; k < result.generation.size(); ++k) {
    const auto value = objective_at(table, objective, k, all);
    if (value && (!least || *value < *least)) least = value;
    const bool last =
        k + 1 == result.generation.size() || result.generation[k + 1] != result.generation[k];
    if (last) history.push_back(figure_text(least));
  }
  return fmt::format("\nBest objective after each generation: {}.\n", fmt::join(history, ", "));
}

/// What was seen of held-out sequences before, which makes the p of the last look too small.
std::string looks_markdown(const TuneResult& result) {
  return fmt::format("**Warning: {}:**\n\n- {}\n\n", looks_text(result.earlier_looks.size()),
                     fmt::join(result.earlier_looks, "\n- "));
}

std::string settings_text(const TuneResult& result) {
  EstimatorSpec spec =
      estimator_at(result.task, result.tables.front().points[result.chosen.front()]);
  spec.label = "tuned";
  return fmt::format("\nAs an estimator beside others:\n\n    --estimators {},{}\n",
                     text_of(result.task.estimator), text_of(spec));
}

std::string single_markdown(const TuneResult& result) {
  const Objective& objective = result.task.plan.objectives.front();
  std::string text = fmt::format("\n{}\n", to_markdown(outcome_table(result)));
  if (!keeps_defaults(result)) {
    text +=
        "The change on the sequences that were tuned on is optimistic: the values were chosen on "
        "them.\n";
  }
  text += "\n## Values\n\n" + response_markdown(result.tables.front(), objective);
  text += history_markdown(result);
  if (!keeps_defaults(result)) text += settings_text(result);
  if (keeps_defaults(result)) return text;
  if (!result.held_out.empty()) {
    text += "\n## Held out\n\n" + to_markdown(gain_table(result.held_out.front(), objective, 0));
  }
  text += "\n## Tuned on\n\n" +
          to_markdown(gain_table(result.tables.front(), objective, result.chosen.front()));
  return text;
}

std::string markdown_of(const TuneResult& result) {
  const TuneTask& task = result.task;
  std::string text = fmt::format("# Tuning `{}`\n\n", text_of(task.estimator));
  if (!result.complete) text += "**Interrupted: only finished points are included.**\n\n";
  if (!result.chosen.empty()) {
    for (const std::string& line : verdict_lines(result)) text += fmt::format("**{}.**\n\n", line);
    if (!result.earlier_looks.empty()) text += looks_markdown(result);
    if (defaults_all_diverged(result.tables.front())) {
      text += fmt::format("**On the sequences tuned on, {}.**\n\n", kNoGain);
    }
  }
  for (const std::string& line : objective_lines(result)) text += fmt::format("- {}\n", line);
  text += fmt::format("- tuned on {}\n", sequences_text(task.sequences));
  text += task.held_out.empty() ? "- nothing held out\n"
                                : fmt::format("- held out {}\n", sequences_text(task.held_out));
  text += fmt::format("- {}\n- code {}\n", search_text(result), code_version());
  for (const std::string& line : defaults_outside(task)) text += fmt::format("- {}\n", line);
  if (result.chosen.empty()) return text;
  if (task.plan.objectives.size() == 1) {
    text += single_markdown(result);
  } else {
    text += "\n## Pareto front\n\nNo point is better than one of these in every objective.\n\n" +
            to_markdown(front_table(result));
    text += "\n## First objective\n\n" +
            response_markdown(result.tables.front(), task.plan.objectives.front());
  }
  return text;
}

CsvTable csv_of(const TuneResult& result) {
  const auto& ranges = result.task.ranges;
  std::vector<std::string> header = {"point", "generation"};
  for (const ParameterRange& range : ranges) header.push_back(range.key);
  for (std::size_t i = 0; i < result.tables.size(); ++i) {
    header.push_back(fmt::format("objective.{}", i));
  }
  CsvTable table(header);
  for (std::size_t k = 0; k < result.generation.size(); ++k) {
    table.add(k).add(result.generation[k]);
    for (const double value : result.tables.front().points[k]) table.add(value);
    for (std::size_t i = 0; i < result.tables.size(); ++i) {
      table.add(objective_at(result.tables[i], result.task.plan.objectives[i], k,
                             cases_of(result.tables[i], "")));
    }
    table.end_row();
  }
  return table;
}

std::vector<std::string> outcome_row(const std::string& name, const ResponseTable& table,
                                     const Objective& planned, std::size_t point) {
  const PairedGain gain = paired_gain(table, planned, point);
  const Objective objective = objective_for(planned, table);
  const auto all = cases_of(table, "");
  const std::string of = gain.scored < gain.sequences ? fmt::format(" (of {})", gain.scored) : "";
  return {name,
          fmt::format("{}", gain.sequences),
          figure_text(gain.median_before) + of,
          figure_text(gain.median_after) + of,
          fmt::format("{}", gain.diverged_before),
          fmt::format("{}", gain.diverged),
          figure_text(objective_at(table, objective, kDefaults, all)),
          figure_text(objective_at(table, objective, point, all)),
          gain.defaults_diverged ? "no meaning: all defaults diverged"
          : gain.gain            ? change_text(*gain.gain)
                                 : "-"};
}

/// Values and, per objective, what it is on the sequences tuned on and held out.
Json outcome_json(const TuneResult& result, const std::vector<double>& values, std::size_t point,
                  std::size_t held) {
  Json json = {{"values", Json::object()}, {"objectives", Json::array()}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    json["values"][result.task.ranges[i].key] = values[i];
  }
  const auto at = [&](const std::vector<ResponseTable>& tables, std::size_t i, std::size_t k) {
    if (i >= tables.size()) return Json();
    const Objective objective = objective_for(result.task.plan.objectives[i], tables[i]);
    return json_of(objective_at(tables[i], objective, k, cases_of(tables[i], "")));
  };
  for (std::size_t i = 0; i < result.tables.size(); ++i) {
    json["objectives"].push_back(
        {{"tuned_on", at(result.tables, i, point)}, {"held_out", at(result.held_out, i, held)}});
  }
  return json;
}

}  // namespace

Json tune_json(const TuneResult& result) {
  Json json = {
      {"schema", "aims.tune/1"},
      {"estimator", text_of(result.task.estimator)},
      {"complete", result.complete},
      {"converged", result.converged},
      {"points", result.tables.empty() ? 0 : distinct_points(result.tables.front()).size()},
      {"tuned_on", result.task.sequences.size()},
      {"held_out", result.task.held_out.size()},
      {"verdict", nullptr},
      {"defaults_diverged", !result.tables.empty() && defaults_all_diverged(result.tables.front())},
      {"objectives", Json::array()},
      {"defaults", nullptr},
      {"chosen", Json::array()}};
  for (const Objective& each : result.task.plan.objectives) {
    json["objectives"].push_back(text_of(each));
  }
  if (result.chosen.empty()) return json;
  json["verdict"] = held_out_verdict(result);
  json["defaults"] = outcome_json(result, result.task.defaults, kDefaults, kDefaults);
  for (std::size_t k = 0; k < result.chosen.size(); ++k) {
    const std::size_t point = result.chosen[k];
    json["chosen"].push_back(outcome_json(result, result.tables.front().points[point], point, k));
  }
  return json;
}

std::string search_text(const TuneResult& result) {
  const std::size_t points = result.tables.empty() ? result.generation.size()
                                                   : distinct_points(result.tables.front()).size();
  const int generations = result.generation.empty() ? 0 : result.generation.back();
  return fmt::format("{} different points in {} generation{} of {}, seed {}{}", points, generations,
                     generations == 1 ? "" : "s", result.task.plan.optimizer.population,
                     result.task.plan.optimizer.seed, result.converged ? ", converged" : "");
}

std::vector<std::string> objective_lines(const TuneResult& result) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < result.task.plan.objectives.size(); ++i) {
    const std::string text = text_of(result.task.plan.objectives[i]);
    lines.push_back("objective: " + text);
    if (i >= result.held_out.size()) continue;
    const std::string held_out =
        text_of(objective_for(result.task.plan.objectives[i], result.held_out[i]));
    if (held_out != text) lines.push_back("on the held-out sequences: " + held_out);
  }
  return lines;
}

TextTable outcome_table(const TuneResult& result) {
  const Objective& objective = result.task.plan.objectives.front();
  const PairedGain of = paired_gain(result.tables.front(), objective, result.chosen.front());
  const std::string score = of.unit.empty() ? of.score : of.score + " " + of.unit;
  TextTable table{{"", "sequences", "median " + score + ", defaults", "tuned", "diverged, defaults",
                   "tuned", "objective, defaults", "tuned", "change"},
                  {}};
  if (!result.held_out.empty()) {
    table.rows.push_back(outcome_row("held out", result.held_out.front(), objective, 0));
  }
  table.rows.push_back(
      outcome_row("tuned on", result.tables.front(), objective, result.chosen.front()));
  return table;
}

TextTable front_table(const TuneResult& result) {
  const TuneTask& task = result.task;
  TextTable text;
  for (const ParameterRange& range : task.ranges) text.header.push_back(range.key);
  for (const Objective& objective : task.plan.objectives) {
    text.header.push_back(axis_label(objective));
    if (!result.held_out.empty()) text.header.push_back(axis_label(objective) + ", held out");
  }
  if (!result.held_out.empty()) text.header.emplace_back("against the defaults, held out");
  const auto tuned_on = common_cases_of(result.tables);
  const auto held_out = common_cases_of(result.held_out);
  const auto row = [&](const std::vector<double>& values, std::size_t point, std::size_t held) {
    std::vector<std::string> cells;
    for (const double value : values) cells.push_back(figure_text(value));
    for (std::size_t i = 0; i < result.tables.size(); ++i) {
      const Objective& objective = task.plan.objectives[i];
      const ResponseTable& table = result.tables[i];
      cells.push_back(figure_text(objective_at(table, objective, point, tuned_on[i])));
      if (result.held_out.empty()) continue;
      const ResponseTable& other = result.held_out[i];
      const Objective here = objective_for(objective, other);
      cells.push_back(figure_text(objective_at(other, here, held, held_out[i])));
    }
    text.rows.push_back(std::move(cells));
  };
  for (std::size_t k = 0; k < result.chosen.size(); ++k) {
    if (result.chosen[k] == 0) continue;  // the defaults, which have a row of their own
    row(result.tables.front().points[result.chosen[k]], result.chosen[k], k);
    if (result.held_out.empty()) continue;
    text.rows.back().emplace_back(name_of(front_verdict_of(front_gains(result, k))));
  }
  row(task.defaults, kDefaults, kDefaults);
  text.rows.back().front() += " (defaults)";
  if (!result.held_out.empty()) text.rows.back().emplace_back("-");
  return text;
}

namespace {

/// Lines about the sequences tuned on and those held out.
std::vector<std::string> of_both(const TuneResult& result,
                                 std::vector<std::string> (*lines_of)(const ResponseTable&)) {
  std::vector<std::string> lines;
  if (!result.tables.empty()) lines = lines_of(result.tables.front());
  if (result.held_out.empty()) return lines;
  const auto held_out = lines_of(result.held_out.front());
  lines.insert(lines.end(), held_out.begin(), held_out.end());
  return lines;
}

}  // namespace

std::vector<std::string> left_out_lines(const TuneResult& result) {
  return of_both(result, left_out_lines);
}

std::vector<std::string> failed_lines(const TuneResult& result) {
  return of_both(result, failed_lines);
}

Result<void> write_tuning(const TuneResult& result, const std::filesystem::path& folder) {
  auto written = write_report({.name = "tune",
                               .markdown = markdown_of(result),
                               .csv = csv_of(result),
                               .json = tune_json(result),
                               .indent = 1},
                              folder);
  if (!written || result.chosen.empty() || result.tables.size() != 1) return written;
  return write_overlay(result, folder / "tuned.yaml");
}

namespace {

/// Lines of `text`, each after "# ".
std::string commented(const std::string& text) {
  std::string result;
  for (const std::string& line : split(text, '\n')) result += "#   " + line + "\n";
  return result;
}

/// Nested YAML of settings whose keys are dotted and sorted.
std::string nested_yaml(const std::vector<std::pair<std::string, std::string>>& settings) {
  std::string text;
  std::vector<std::string> open;
  for (const auto& [key, value] : settings) {
    const std::vector<std::string> parts = split(key, '.');
    std::size_t shared = 0;
    while (shared + 1 < parts.size() && shared < open.size() && open[shared] == parts[shared]) {
      ++shared;
    }
    for (std::size_t i = shared; i < parts.size(); ++i) {
      text += fmt::format("{}{}:{}\n", std::string(2 * i, ' '), parts[i],
                          i + 1 == parts.size() ? " " + value : "");
    }
    open.assign(parts.begin(), parts.end() - 1);
  }
  return text;
}

}  // namespace

std::string overlay_text(const TuneResult& result) {
  const TuneTask& task = result.task;
  std::string text =
      fmt::format("# Values of `{}` by aims tune; on top of any scenario: --set @FILE\n",
                  text_of(task.estimator));
  for (const std::string& line : verdict_lines(result)) text += fmt::format("# {}\n", line);
  if (!result.earlier_looks.empty()) {
    text += fmt::format("# warning: {}\n", looks_text(result.earlier_looks.size()));
  }
  text += fmt::format("# objective: {}\n", text_of(task.plan.objectives.front()));
  const PairedGain tuned =
      paired_gain(result.tables.front(), task.plan.objectives.front(), result.chosen.front());
  text += fmt::format("# tuned on {}: {} there\n", sequences_text(task.sequences),
                      tuned.defaults_diverged ? kNoGain
                      : tuned.gain            ? change_text(*tuned.gain)
                                              : std::string("no figure"));
  if (!result.held_out.empty()) {
    text += fmt::format("# held out {}\n", sequences_text(task.held_out));
  }
  text += fmt::format("# search: {}\n# code: {}\n# plan:\n{}", search_text(result), code_version(),
                      commented(plan_text(task.plan)));
  auto settings = settings_of(task, result.tables.front().points[result.chosen.front()]);
  if (keeps_defaults(result)) settings.clear();
  const EstimatorSpec& estimator = result.task.estimator;
  const std::string& name = is_python_name(estimator.name) ? estimator.label : estimator.name;
  for (auto& [key, value] : settings) key = fmt::format("estimators.{}.{}", name, key);
  std::sort(settings.begin(), settings.end());
  return text + (settings.empty() ? "{}\n" : nested_yaml(settings));
}

Result<void> write_overlay(const TuneResult& result, const std::filesystem::path& file) {
  return write_file_atomically(file, overlay_text(result));
}

}  // namespace aims
