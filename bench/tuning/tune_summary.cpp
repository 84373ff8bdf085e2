// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/tune_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "bench/run/code_version.hpp"
#include "bench/tuning/response_summary.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/csv.hpp"
#include "estimator/python/python_estimator.hpp"

namespace aims {
namespace {

/// "corridor, severity_5; seeds 1 2 3".
std::string sequences_text(std::span<const ScenarioSeed> sequences) {
  std::vector<std::string> scenarios;
  std::vector<std::string> seeds;
  const auto add = [](std::vector<std::string>& texts, const std::string& text) {
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
  };
  for (const ScenarioSeed& sequence : sequences) {
    add(scenarios, sequence.scenario->name);
    add(seeds, fmt::format("{}", sequence.seed));
  }
  return fmt::format("{} sequences: {}; seeds {}", sequences.size(), fmt::join(scenarios, ", "),
                     fmt::join(seeds, " "));
}

std::string interval_text(const Interval& interval) {
  if (!interval.low || !interval.high) return "-";
  return fmt::format("{:+.1f} to {:+.1f}", 100.0 * *interval.low, 100.0 * *interval.high);
}

/// The chosen point alone, as the best of a table.
Result<BestPoint> chosen_point(const TuneResult& result, bool held_out) {
  ResponseTable table = held_out ? result.held_out.front() : result.tables.front();
  const std::size_t point = held_out ? 0 : result.chosen.front();
  table.points = {table.points[point]};
  table.runs = {table.runs[point]};
  return best_point(table, result.task.plan.objectives.front());
}

std::vector<std::string> outcome_row(const std::string& name, const Result<BestPoint>& point) {
  if (!point) return {name, "-", "-", "-", "-"};
  const std::string gain = point->gain ? fmt::format("{:+.1f} %", 100.0 * *point->gain) : "-";
  return {name, figure_text(point->defaults),
          figure_text(point->objective, point->objective_interval), gain,
          interval_text(point->gain_interval)};
}

/// Whether the gain holds on the held-out sequences.
std::string verdict(const TuneResult& result) {
  if (result.held_out.empty()) {
    return "**No sequences were held out, so the gain is not validated.**\n";
  }
  const auto tuned = chosen_point(result, false);
  const auto held = chosen_point(result, true);
  if (!tuned || !held || !tuned->gain || !held->gain) return "";
  const Interval& interval = held->gain_interval;
  if (!interval.low || !interval.high) return "One held-out seed gives the gain no interval.\n";
  if (*interval.low > 0.0) {
    return fmt::format(
        "The gain holds on the held-out sequences, where it is {:.0f} % of that on the tuned "
        "ones.\n",
        100.0 * *held->gain / std::max(1e-9, *tuned->gain));
  }
  return *interval.high < 0.0
             ? "**On the held-out sequences the tuned values are worse than the defaults.**\n"
             : "**On the held-out sequences the gain is not significant: keep the defaults unless "
               "there is\nanother reason.**\n";
}

std::string search_text(const TuneResult& result) {
  const int generations = result.generation.empty() ? 0 : result.generation.back();
  return fmt::format("{} points in {} generations of {}, seed {}{}", result.generation.size(),
                     generations, result.task.plan.optimizer.population,
                     result.task.plan.optimizer.seed, result.converged ? ", converged" : "");
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

std::string settings_text(const TuneResult& result) {
  EstimatorSpec spec =
      estimator_at(result.task, result.tables.front().points[result.chosen.front()]);
  spec.label = "tuned";
  return fmt::format("\nAs an estimator beside others:\n\n    --estimators {},{}\n",
                     text_of(result.task.estimator), text_of(spec));
}

std::string single_markdown(const TuneResult& result) {
  const Objective& objective = result.task.plan.objectives.front();
  std::string text = fmt::format("\n{}\n{}", to_markdown(outcome_table(result)), verdict(result));
  text += "\n## Values\n\n" + response_markdown(result.tables.front(), objective);
  text += history_markdown(result);
  text += settings_text(result);
  text += "\n## Tuned on\n\n" +
          to_markdown(gain_table(result.tables.front(), objective, result.chosen.front()));
  if (!result.held_out.empty()) {
    text += "\n## Held out\n\n" + to_markdown(gain_table(result.held_out.front(), objective, 0));
  }
  return text;
}

std::string markdown_of(const TuneResult& result, const std::vector<std::string>& pictures) {
  const TuneTask& task = result.task;
  std::string text = fmt::format("# Tuning `{}`\n\n", text_of(task.estimator));
  if (!result.complete) text += "**Interrupted: only finished points are included.**\n\n";
  for (const Objective& objective : task.plan.objectives) {
    text += fmt::format("- objective: {}\n", text_of(objective));
  }
  text += fmt::format("- tuned on {}\n", sequences_text(task.sequences));
  text += task.held_out.empty() ? "- nothing held out\n"
                                : fmt::format("- held out {}\n", sequences_text(task.held_out));
  text += fmt::format("- {}\n- code {}\n", search_text(result), code_version());
  if (result.chosen.empty()) return text;
  if (task.plan.objectives.size() == 1) {
    text += single_markdown(result);
  } else {
    text += "\n## Pareto front\n\nNo point is better than one of these in every objective.\n\n" +
            to_markdown(front_table(result));
    text += "\n## First objective\n\n" +
            response_markdown(result.tables.front(), task.plan.objectives.front());
  }
  if (!pictures.empty()) text += "\n## Pictures\n" + pictures_markdown(pictures);
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
    table.add(static_cast<std::int64_t>(k)).add(static_cast<std::int64_t>(result.generation[k]));
    for (const double value : result.tables.front().points[k]) table.add(value);
    for (std::size_t i = 0; i < result.tables.size(); ++i) {
      table.add(objective_at(result.tables[i], result.task.plan.objectives[i], k,
                             cases_of(result.tables[i], "")));
    }
    table.end_row();
  }
  return table;
}

/// Lines of `text`, each after "# ".
std::string commented(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) result += "#   " + line + "\n";
  return result;
}

/// Nested YAML of settings whose keys are dotted and sorted.
std::string nested_yaml(const std::vector<std::pair<std::string, std::string>>& settings) {
  std::string text;
  std::vector<std::string> open;
  for (const auto& [key, value] : settings) {
    std::vector<std::string> parts;
    std::istringstream stream(key);
    for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
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

std::string outcome_line(const char* name, const Result<BestPoint>& point) {
  if (!point) return fmt::format("# {}: -\n", name);
  return fmt::format("# {}: {} of the defaults, {} of these; gain {} % [{}]\n", name,
                     figure_text(point->defaults),
                     figure_text(point->objective, point->objective_interval),
                     point->gain ? fmt::format("{:+.1f}", 100.0 * *point->gain) : "-",
                     interval_text(point->gain_interval));
}

}  // namespace

std::string overlay_text(const TuneResult& result) {
  const TuneTask& task = result.task;
  std::string text =
      fmt::format("# Values of `{}` by aims tune; on top of any scenario: --set @FILE\n",
                  text_of(task.estimator));
  text += fmt::format("# objective: {}\n", text_of(task.plan.objectives.front()));
  text += fmt::format("# tuned on {}\n", sequences_text(task.sequences));
  text += outcome_line("  objective there", chosen_point(result, false));
  if (!result.held_out.empty()) {
    text += fmt::format("# held out {}\n", sequences_text(task.held_out));
    text += outcome_line("  objective there", chosen_point(result, true));
  }
  text += fmt::format("# search: {}\n# code: {}\n# plan:\n{}", search_text(result), code_version(),
                      commented(plan_text(task.plan)));
  auto settings = settings_of(task, result.tables.front().points[result.chosen.front()]);
  const EstimatorSpec& estimator = result.task.estimator;
  const std::string& name = is_python_name(estimator.name) ? estimator.label : estimator.name;
  for (auto& [key, value] : settings) key = fmt::format("estimators.{}.{}", name, key);
  std::sort(settings.begin(), settings.end());
  return text + nested_yaml(settings);
}

TextTable outcome_table(const TuneResult& result) {
  TextTable table{{"objective", "defaults", "tuned [95 %]", "gain", "95 %"}, {}};
  table.rows.push_back(outcome_row("tuned on", chosen_point(result, false)));
  if (!result.held_out.empty()) {
    table.rows.push_back(outcome_row("held out", chosen_point(result, true)));
  }
  return table;
}

TextTable front_table(const TuneResult& result) {
  const TuneTask& task = result.task;
  TextTable text;
  for (const ParameterRange& range : task.ranges) text.header.push_back(range.key);
  for (const Objective& objective : task.plan.objectives) {
    text.header.push_back(objective.score);
    if (!result.held_out.empty()) text.header.push_back(objective.score + ", held out");
  }
  const auto row = [&](const std::vector<double>& values, std::size_t point, std::size_t held) {
    std::vector<std::string> cells;
    for (const double value : values) cells.push_back(figure_text(value));
    for (std::size_t i = 0; i < result.tables.size(); ++i) {
      const Objective& objective = task.plan.objectives[i];
      const ResponseTable& table = result.tables[i];
      cells.push_back(figure_text(objective_at(table, objective, point, cases_of(table, ""))));
      if (result.held_out.empty()) continue;
      const ResponseTable& other = result.held_out[i];
      cells.push_back(figure_text(objective_at(other, objective, held, cases_of(other, ""))));
    }
    text.rows.push_back(std::move(cells));
  };
  for (std::size_t k = 0; k < result.chosen.size(); ++k) {
    row(result.tables.front().points[result.chosen[k]], result.chosen[k], k);
  }
  row(task.defaults, kDefaults, kDefaults);
  text.rows.back().front() += " (defaults)";
  return text;
}

std::vector<std::string> left_out_lines(const TuneResult& result) {
  std::vector<std::string> lines;
  if (!result.tables.empty()) lines = left_out_lines(result.tables.front());
  if (result.held_out.empty()) return lines;
  const auto held_out = left_out_lines(result.held_out.front());
  lines.insert(lines.end(), held_out.begin(), held_out.end());
  return lines;
}

Result<void> write_tuning(const TuneResult& result, const std::filesystem::path& folder,
                          const DrawResponse& draw, std::vector<std::string>& warnings) {
  std::vector<std::string> pictures;
  if (!result.chosen.empty()) {
    auto drawn = draw(result.tables.front(), result.task.plan.objectives.front(), folder);
    if (drawn) {
      pictures = std::move(*drawn);
    } else {
      warnings.push_back(drawn.error().message);
    }
  }
  auto written = write_file_atomically(folder / "tune.md", markdown_of(result, pictures));
  if (!written) return written;
  written = write_file_atomically(folder / "tune.csv", csv_of(result).text());
  if (!written || result.chosen.empty() || result.tables.size() != 1) return written;
  return write_overlay(result, folder / "tuned.yaml");
}

Result<void> write_overlay(const TuneResult& result, const std::filesystem::path& file) {
  return write_file_atomically(file, overlay_text(result));
}

}  // namespace aims
