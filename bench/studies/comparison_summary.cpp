// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "bench/scoring/report.hpp"
#include "bench/studies/comparison.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The smallest change that would have been better or worse, of one in which nothing was detected.
std::optional<double> detectable(const ScoreChange& change) {
  const bool undetected =
      change.verdict == ChangeVerdict::kNone || change.verdict == ChangeVerdict::kTooFew;
  if (!undetected || !change.test.detectable) return std::nullopt;
  return std::max(*change.test.detectable, change.floor);
}

constexpr std::string_view kComparisonSchema = "aims.compare/3";

std::optional<double> ratio_of(const ScoreChange& change) {
  return change.before > 0.0 ? std::optional(change.after / change.before) : std::nullopt;
}

std::optional<std::size_t> lost(const ScoreChange& change) {
  return change.success ? std::optional(change.success->only_first) : std::nullopt;
}

std::optional<std::size_t> won(const ScoreChange& change) {
  return change.success ? std::optional(change.success->only_second) : std::nullopt;
}

std::string change_text(const ScoreChange& change) {
  std::string text = fmt::format("{:+.4f}", change.test.change);
  if (change.test.interval.low) text += " " + interval_text(change.test.interval, "{:+.4f}");
  if (change.success) text += fmt::format(" (-{} +{})", *lost(change), *won(change));
  return text;
}

const TableColumns<ScoreChange>& change_columns() {
  using Change = ScoreChange;
  static const TableColumns<Change> columns = {
      {"scenario", "scenario", &Change::scenario},
      {"estimator", "estimator", &Change::estimator},
      {"score", "score", &Change::score},
      {"seeds", "seeds", &Change::pairs},
      {"before", "before", &Change::before, "{:.4f}"},
      {"after", "after", &Change::after, "{:.4f}"},
      {"worst_after", "", &Change::worst_after},
      {"ratio", "", ratio_of},
      {"change", "", [](const Change& c) { return c.test.change; }},
      {"change_low", "", [](const Change& c) { return c.test.interval.low; }},
      {"change_high", "", [](const Change& c) { return c.test.interval.high; }},
      {"", "change [95 %]", change_text},
      {"p", "p", [](const Change& c) { return c.test.p; }, "{:.3f}"},
      {"lost", "", lost},
      {"won", "", won},
      {"detectable", "detectable", detectable, "{:.4f}"},
      {"floor", "", &Change::floor},
      {"verdict", "verdict", [](const Change& c) { return name_of(c.verdict); }},
      {"false_alarm", "", &Change::false_alarm}};
  return columns;
}

std::string list_markdown(const char* title, const std::vector<std::string>& runs) {
  if (runs.empty()) return "";
  return fmt::format("\n## {}\n\n- {}\n", title, fmt::join(runs, "\n- "));
}

std::string comparison_markdown(const Comparison& comparison, const std::string& before,
                                const std::string& after) {
  std::string text =
      fmt::format("# {} against {}\n\n{}\n", after, before, summary_text(comparison));
  if (const std::string set = settings_text(comparison); !set.empty()) text += "\n" + set;
  text += fmt::format("\n{}\n{}", to_markdown(change_table(comparison)), rule_text(comparison));
  text += list_markdown("Fails now", comparison.fails_now);
  text += list_markdown("Fails no more", comparison.fails_no_more);
  text += list_markdown("Success alone compared: an estimate lacks a part of the run",
                        comparison.partial);
  text += list_markdown("Only before", comparison.only_before);
  text += list_markdown("Only after", comparison.only_after);
  return text + list_markdown("Invalid and left out", comparison.invalid);
}

}  // namespace

std::string_view name_of(ChangeVerdict verdict) {
  switch (verdict) {
    case ChangeVerdict::kBetter:
      return "better";
    case ChangeVerdict::kWorse:
      return "worse";
    case ChangeVerdict::kTooFew:
      return "too few";
    case ChangeVerdict::kSmall:
      return "small";
    case ChangeVerdict::kNone:
      return "none";
    case ChangeVerdict::kSame:
      break;
  }
  return "same";
}

Json comparison_json(const Comparison& comparison, const std::string& before,
                     const std::string& after) {
  return {{"schema", kComparisonSchema},
          {"before", before},
          {"after", after},
          {"set_before", comparison.set_before},
          {"set_after", comparison.set_after},
          {"other_sequences", comparison.other_sequences},
          {"other_specs", comparison.other_specs},
          {"compared", comparison.changes.size()},
          {"better", count(comparison, ChangeVerdict::kBetter)},
          {"worse", count(comparison, ChangeVerdict::kWorse)},
          {"expected_false_alarms", comparison.expected_false_alarms},
          {"rule", rule_text(comparison)},
          {"changes", rows_json(change_columns(), comparison.changes)},
          {"fails_now", comparison.fails_now},
          {"fails_no_more", comparison.fails_no_more},
          {"partial", comparison.partial},
          {"only_before", comparison.only_before},
          {"only_after", comparison.only_after},
          {"invalid", comparison.invalid}};
}

Comparison with_settings(Comparison comparison, std::vector<std::string> before,
                         std::vector<std::string> after) {
  std::ranges::sort(before);
  std::ranges::sort(after);
  std::ranges::set_difference(before, after, std::back_inserter(comparison.set_before));
  std::ranges::set_difference(after, before, std::back_inserter(comparison.set_after));
  return comparison;
}

std::string settings_text(const Comparison& comparison) {
  const auto listed = [](const std::vector<std::string>& settings) {
    return settings.empty() ? "nothing" : fmt::format("{}", fmt::join(settings, ", "));
  };
  const auto of_task = [](const std::string& setting) {
    return !setting.starts_with("estimators.") && !setting.starts_with("run.");
  };
  const auto& before = comparison.set_before;
  const auto& after = comparison.set_after;
  const auto& sequences = comparison.other_sequences;
  std::string text;
  if (!before.empty() || !after.empty()) {
    text = fmt::format("Set on one side alone: before: {}; after: {}.\n", listed(before),
                       listed(after));
  }
  if (!comparison.other_specs.empty()) {
    text +=
        fmt::format("One label, two estimators: {}.\n", fmt::join(comparison.other_specs, "; "));
  }
  if (!sequences.empty() || std::ranges::any_of(before, of_task) ||
      std::ranges::any_of(after, of_task)) {
    text += fmt::format(
        "The sequences differ{}{}: changes are those of the task too, not of the estimators "
        "alone.\n",
        sequences.empty() ? "" : ": ", fmt::join(sequences, "; "));
  }
  return text;
}

std::string summary_text(const Comparison& comparison) {
  std::string text = fmt::format(
      "{} scores compared over common seeds: {} better, {} worse beyond noise; about {:.1f} false "
      "alarms are expected.",
      comparison.changes.size(), count(comparison, ChangeVerdict::kBetter),
      count(comparison, ChangeVerdict::kWorse), comparison.expected_false_alarms);
  if (const std::size_t few = count(comparison, ChangeVerdict::kTooFew); few > 0) {
    text += fmt::format(" {} differ on too few common seeds to tell: run {} or more.", few,
                        kFewestPairs);
  }
  return text;
}

std::string rule_text(const Comparison& comparison) {
  std::string text =
      "before, after: means over the seeds. change: mean of the paired differences, with the 95 %\n"
      "interval of the sign-flip test; it excludes zero exactly when p <= 0.05. better, worse: it\n"
      "excludes zero, and the change exceeds 5 % of before and 0.01 m (M_list: 0.02 %, heading:\n"
      "1 mrad); small: the change does not. detectable: where nothing was detected, the smallest\n"
      "change that would have been. success (within 5 % of the distance), success_1_percent:\n"
      "fraction of the runs, how many are lost (-) and won (+), and p of McNemar's exact test.\n";
  std::set<std::size_t> few;
  for (const ScoreChange& each : comparison.changes) {
    if (each.verdict == ChangeVerdict::kTooFew) few.insert(each.pairs);
  }
  for (const std::size_t pairs : few) {
    text +=
        fmt::format("{} pair{}: the smallest p that this test can reach is {:.4g}: no verdict.\n",
                    pairs, pairs == 1 ? "" : "s", smallest_p(pairs));
  }
  return text;
}

TextTable change_table(const Comparison& comparison) {
  std::vector<ScoreChange> changes = comparison.changes;
  std::ranges::stable_sort(changes, {}, &ScoreChange::verdict);
  return rows_table(change_columns(), changes);
}

Result<void> write_comparison(const Comparison& comparison, const std::string& before,
                              const std::string& after, const fs::path& folder) {
  return write_report({.name = "compare",
                       .markdown = comparison_markdown(comparison, before, after),
                       .json = comparison_json(comparison, before, after)},
                      folder);
}

}  // namespace aims
