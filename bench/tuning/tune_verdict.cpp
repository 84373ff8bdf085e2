// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/tune_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/metrics/paired_test.hpp"
#include "bench/tuning/effect.hpp"
#include "bench/tuning/range_key.hpp"
#include "bench/tuning/response_summary.hpp"
#include "bench/tuning/tune_plan.hpp"
#include "core/files/atomic_file.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr const char* kLooks = "held_out.txt";

/// "none of the 4 other points is better"; of one, "the one other point is not better".
std::string none_better(std::size_t count, std::string_view kind, std::string_view of = "") {
  if (count == 1) return fmt::format("the one {}point{} is not better", kind, of);
  return fmt::format("none of the {} {}points{} is better", count, kind, of);
}

}  // namespace

PairedGain held_out_gain(const TuneResult& result) {
  if (result.held_out.empty()) return {};
  return paired_gain(result.held_out.front(), result.task.plan.objectives.front(), 0);
}

std::vector<PairedGain> front_gains(const TuneResult& result, std::size_t chosen) {
  std::vector<PairedGain> gains;
  for (std::size_t i = 0; i < result.held_out.size(); ++i) {
    gains.push_back(paired_gain(result.held_out[i], result.task.plan.objectives[i], chosen));
  }
  return gains;
}

std::vector<std::string> verdict_lines(const TuneResult& result) {
  std::vector<std::string> lines;
  if (result.tables.size() == 1) {
    const TuneTask& task = result.task;
    lines.push_back("tuned values: " +
                    (keeps_defaults(result)
                         ? "none"
                         : values_text(task.ranges, task.defaults,
                                       result.tables.front().points[result.chosen.front()],
                                       without_effect(result.tables.front()))));
  }
  lines.push_back("verdict: " + held_out_verdict(result));
  return lines;
}

std::string held_out_verdict(const TuneResult& result) {
  if (keeps_defaults(result) && all_diverged(result.tables.front())) {
    return "undecided: every run diverged or failed, with the defaults and with every other point";
  }
  if (keeps_defaults(result) && result.tables.size() > 1) {
    return fmt::format(
        "keep the defaults: the Pareto front has no other point: {} in an objective on the "
        "sequences tuned on",
        none_better(other_points(result.tables.front()), "other "));
  }
  if (keeps_defaults(result)) {
    return fmt::format("keep the defaults: {} on the sequences tuned on",
                       none_better(other_points(result.tables.front()), "other "));
  }
  if (result.held_out.empty() && !result.task.held_out.empty()) {
    return "not validated: interrupted before the held-out sequences were all run";
  }
  if (result.task.plan.objectives.size() > 1) return front_verdict(result);
  return verdict_text(held_out_gain(result));
}

std::string front_verdict(const TuneResult& result) {
  if (result.held_out.empty()) {
    return "not validated: no sequence was held out, and a gain on the sequences that were tuned "
           "on may be overfitting";
  }
  if (defaults_all_diverged(result.held_out.front())) {
    return fmt::format("undecided: on the held-out sequences, {}", kNoGain);
  }
  std::size_t better = 0;
  for (std::size_t k = 0; k < result.chosen.size(); ++k) {
    const auto verdict = front_verdict_of(front_gains(result, k));
    if (verdict == FrontVerdict::kTooFew) {
      return fmt::format("undecided: too few held-out seeds for an interval ({} are needed)",
                         kFewestPairs);
    }
    if (verdict == FrontVerdict::kBetter) ++better;
  }
  const auto points = static_cast<std::size_t>(
      std::ranges::count_if(result.chosen, [](std::size_t point) { return point != 0; }));
  const std::string on =
      fmt::format("on {}", counted(result.held_out.front().cases.size(), "held-out sequence"));
  if (better == 0) {
    return fmt::format("do not use {}: {} than the defaults {}", points == 1 ? "it" : "them",
                       none_better(points, "", " of the front"), on);
  }
  if (points == 1) {
    return fmt::format(
        "use it: the one point of the front is significantly better in one objective and in none "
        "worse than the defaults {}",
        on);
  }
  return fmt::format(
      "use one of those marked better: {} of the {} points of the front, significantly in one "
      "objective and in none worse than the defaults {}",
      better, points, on);
}

std::string looks_text(std::size_t earlier) {
  return fmt::format(
      "held-out results were looked at {} before; sequences that are added after a look "
      "make p too small. Confirm the values on sequences that were never looked at",
      counted(earlier, "time"));
}

std::vector<std::string> looks_in(const std::filesystem::path& folder) {
  return split(read_file(folder / kLooks).value_or(""), '\n');
}

Result<void> note_look(TuneResult& result, const std::filesystem::path& folder) {
  std::vector<std::string>& looks = result.earlier_looks = looks_in(folder);
  if (result.held_out.empty()) return {};
  const std::string look =
      fmt::format("{}: {}", sequences_text(result.task.held_out), held_out_verdict(result));
  if (!looks.empty() && looks.back() == look) looks.pop_back();
  std::string text;
  for (const std::string& each : looks) text += each + "\n";
  return write_file_atomically(folder / kLooks, text + look + "\n");
}

}  // namespace aims
