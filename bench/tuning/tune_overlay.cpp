// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/tune_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "bench/run/code_version.hpp"
#include "bench/tuning/tune_summary.hpp"
#include "bench/tuning/tune_verdict.hpp"
#include "core/files/atomic_file.hpp"
#include "estimator/python/python_estimator.hpp"

namespace aims {
namespace {

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
