// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <system_error>

#include "bench/run/json_text.hpp"
#include "bench/studies/comparison.hpp"
#include "core/files/atomic_file.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kComparisonSchema = "aims.compare/2";

std::string_view name_of(ChangeVerdict verdict) {
  switch (verdict) {
    case ChangeVerdict::kBetter:
      return "better";
    case ChangeVerdict::kWorse:
      return "worse";
    case ChangeVerdict::kUnknown:
      return "one seed";
    case ChangeVerdict::kNone:
      break;
  }
  return "none";
}

Json change_json(const ScoreChange& change) {
  return {{"scenario", change.scenario},
          {"estimator", change.estimator},
          {"score", change.score},
          {"seeds", change.pairs.count},
          {"before", change.before},
          {"after", change.after},
          {"worst_after", json_of(change.pairs.worst)},
          {"ratio", json_of(change.pairs.ratio)},
          {"change", change.pairs.change},
          {"change_low", json_of(change.pairs.interval.low)},
          {"change_high", json_of(change.pairs.interval.high)},
          {"verdict", name_of(change.verdict)},
          {"false_alarm", change.false_alarm}};
}

std::string list_markdown(const char* title, const std::vector<std::string>& runs) {
  if (runs.empty()) return "";
  return fmt::format("\n## {}\n\n- {}\n", title, fmt::join(runs, "\n- "));
}

std::string comparison_markdown(const Comparison& comparison, const std::string& before,
                                const std::string& after) {
  std::string text =
      fmt::format("# {} against {}\n\n{}\n", after, before, summary_text(comparison));
  for (const ChangeVerdict verdict :
       {ChangeVerdict::kWorse, ChangeVerdict::kBetter, ChangeVerdict::kUnknown}) {
    if (count(comparison, verdict) == 0) continue;
    text += fmt::format("\n## {}\n\n{}", name_of(verdict),
                        to_markdown(change_table(comparison, verdict)));
  }
  text += list_markdown("Only before", comparison.only_before);
  return text + list_markdown("Only after", comparison.only_after);
}

}  // namespace

Json comparison_json(const Comparison& comparison, const std::string& before,
                     const std::string& after) {
  Json json = {{"schema", kComparisonSchema},
               {"before", before},
               {"after", after},
               {"compared", comparison.changes.size()},
               {"better", count(comparison, ChangeVerdict::kBetter)},
               {"worse", count(comparison, ChangeVerdict::kWorse)},
               {"expected_false_alarms", comparison.expected_false_alarms},
               {"changes", Json::array()},
               {"only_before", comparison.only_before},
               {"only_after", comparison.only_after}};
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
  if (const std::size_t unknown = count(comparison, ChangeVerdict::kUnknown); unknown > 0) {
    text += fmt::format(
        " {} differ on the one seed that is common, without a measure of noise: run more seeds.",
        unknown);
  }
  return text;
}

TextTable change_table(const Comparison& comparison, ChangeVerdict verdict) {
  TextTable table;
  table.header = {"scenario", "estimator", "score", "seeds", "before", "after", "change [95 %]"};
  for (const ScoreChange& change : comparison.changes) {
    if (change.verdict != verdict) continue;
    std::string interval = fmt::format("{:+.4f}", change.pairs.change);
    if (const Interval& range = change.pairs.interval; range.low) {
      interval += fmt::format(" [{:+.4f}, {:+.4f}]", *range.low, *range.high);
    }
    table.rows.push_back({change.scenario, change.estimator, change.score,
                          std::to_string(change.pairs.count), fmt::format("{:.4f}", change.before),
                          fmt::format("{:.4f}", change.after), interval});
  }
  return table;
}

Result<void> write_comparison(const Comparison& comparison, const std::string& before,
                              const std::string& after, const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return failure(fmt::format("{}: {}", folder.string(), code.message()));
  auto written = write_file_atomically(
      folder / "compare.json", json_text(comparison_json(comparison, before, after), 2) + "\n");
  if (!written) return written;
  return write_file_atomically(folder / "compare.md",
                               comparison_markdown(comparison, before, after));
}

}  // namespace aims
