// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "bench/studies/comparison.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The smallest change that would have been better or worse.
std::optional<double> detectable(const ScoreChange& change) {
  if (!change.test.detectable) return std::nullopt;
  return std::max(*change.test.detectable, change.floor);
}

constexpr std::string_view kComparisonSchema = "aims.compare/3";

Json change_json(const ScoreChange& change) {
  return {{"scenario", change.scenario},
          {"estimator", change.estimator},
          {"score", change.score},
          {"seeds", change.pairs},
          {"before", change.before},
          {"after", change.after},
          {"worst_after", change.worst_after},
          {"ratio", change.before > 0.0 ? Json(change.after / change.before) : Json()},
          {"change", change.test.change},
          {"change_low", json_of(change.test.interval.low)},
          {"change_high", json_of(change.test.interval.high)},
          {"p", change.test.p},
          {"lost", change.success ? Json(change.success->only_first) : Json()},
          {"won", change.success ? Json(change.success->only_second) : Json()},
          {"detectable", json_of(detectable(change))},
          {"floor", change.floor},
          {"verdict", name_of(change.verdict)},
          {"false_alarm", change.false_alarm}};
}

std::vector<std::string> change_row(const ScoreChange& change) {
  std::string size = fmt::format("{:+.4f}", change.test.change);
  if (const Interval& range = change.test.interval; range.low) {
    size += fmt::format(" [{:+.4f}, {:+.4f}]", *range.low, *range.high);
  }
  if (change.success) {
    size += fmt::format(" (-{} +{})", change.success->only_first, change.success->only_second);
  }
  const auto smallest = detectable(change);
  return {change.scenario,
          change.estimator,
          change.score,
          std::to_string(change.pairs),
          fmt::format("{:.4f}", change.before),
          fmt::format("{:.4f}", change.after),
          size,
          fmt::format("{:.3f}", change.test.p),
          smallest ? fmt::format("{:.4f}", *smallest) : "-",
          std::string(name_of(change.verdict))};
}

std::string list_markdown(const char* title, const std::vector<std::string>& runs) {
  if (runs.empty()) return "";
  return fmt::format("\n## {}\n\n- {}\n", title, fmt::join(runs, "\n- "));
}

std::string comparison_markdown(const Comparison& comparison, const std::string& before,
                                const std::string& after) {
  std::string text =
      fmt::format("# {} against {}\n\n{}\n", after, before, summary_text(comparison));
  text += fmt::format("\n{}\n{}", to_markdown(change_table(comparison)), rule_text(comparison));
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
  Json json = {{"schema", kComparisonSchema},
               {"before", before},
               {"after", after},
               {"compared", comparison.changes.size()},
               {"better", count(comparison, ChangeVerdict::kBetter)},
               {"worse", count(comparison, ChangeVerdict::kWorse)},
               {"expected_false_alarms", comparison.expected_false_alarms},
               {"rule", rule_text(comparison)},
               {"changes", Json::array()},
               {"only_before", comparison.only_before},
               {"only_after", comparison.only_after},
               {"invalid", comparison.invalid}};
  for (const ScoreChange& change : comparison.changes) {
    json["changes"].push_back(change_json(change));
  }
  return json;
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
      "1 mrad); small: the change does not. detectable: the smallest change that this scatter "
      "would\n"
      "have shown. success (within 5 % of the distance), success_1_percent: fraction of the runs, "
      "how\n"
      "many are lost (-) and won (+), and p of McNemar's exact test.\n";
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
  TextTable table;
  table.header = {"scenario", "estimator",     "score", "seeds",      "before",
                  "after",    "change [95 %]", "p",     "detectable", "verdict"};
  std::vector<ScoreChange> changes = comparison.changes;
  std::ranges::stable_sort(changes, {}, &ScoreChange::verdict);
  std::ranges::transform(changes, std::back_inserter(table.rows), change_row);
  return table;
}

Result<void> write_comparison(const Comparison& comparison, const std::string& before,
                              const std::string& after, const fs::path& folder) {
  return write_report({.name = "compare",
                       .markdown = comparison_markdown(comparison, before, after),
                       .json = comparison_json(comparison, before, after)},
                      folder);
}

}  // namespace aims
