// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "bench/run/code_version.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/studies/ablation.hpp"
#include "core/files/csv.hpp"

namespace aims {
namespace {

constexpr const char* kAblationIntroduction =
    "# Ablation of `{0}`\n"
    "\n"
    "`no_PART` is `{0}` with that part turned off, on the same measurements (`with_PART`: turned\n"
    "on where it is off). Figures are medians over seeds; in brackets the ratio to `{0}`: above 1\n"
    "the part helps. NEES is 1 when the stated covariance is right. Success: within 5 and 1 % of\n"
    "the distance, with 95 % Wilson intervals; p of McNemar's exact test against `{0}`, within 5 "
    "%.\n";

std::string ratio_text(const std::optional<double>& ratio) {
  return ratio ? fmt::format("{:.3g}", *ratio) : "-";
}

std::string cell_text(const PairedStatistics& cell, int digits) {
  if (!cell.median) return "-";
  std::string text = fmt::format("{:.{}f}", *cell.median, digits);
  if (cell.ratio) text += fmt::format(" (x{:.3g})", *cell.ratio);
  return text;
}

std::string markdown_of(const Ablation& ablation, const Suite& suite) {
  std::string text = fmt::format(kAblationIntroduction, ablation.complete);
  if (!suite.complete) text += "\n**Interrupted: of the finished runs alone.**\n";
  text +=
      "\n## Over all scenarios\n\nGeometric means of the ratios; last, the largest of the "
      "ATE yaw.\n\n" +
      to_markdown(effect_table(ablation));
  for (const AblationCase& each : ablation.cases) {
    const std::size_t runs = each.rows.empty() ? 0 : each.rows.front().runs;
    text += fmt::format("\n## {}, {} runs\n\n{}", each.scenario, runs,
                        each.rows.empty() ? "" : to_markdown(case_table(each)));
  }
  text += "\n## Settings\n\n";
  for (const AblationEffect& each : ablation.effects) {
    text += fmt::format("- `{}`: `{}`\n", each.label, each.changes);
  }
  for (const std::string& line : left_out_lines(suite)) text += fmt::format("- {}\n", line);
  for (const SuiteFailure& each : suite.failures) {
    text += fmt::format("- failed: {}\n", text_of(each));
  }
  return text;
}

CsvTable csv_of(const Ablation& ablation) {
  CsvTable table({"scenario", "variant", "score", "median", "worst", "ratio", "change",
                  "change_low", "change_high", "count", "runs", "successes"});
  for (const AblationCase& each : ablation.cases) {
    for (const AblationRow& row : each.rows) {
      for (std::size_t i = 0; i < kAblationCount; ++i) {
        const PairedStatistics& cell = row.cells[i];
        table.add(each.scenario).add(row.label).add(ablation_scores()[i].key);
        table.add(cell.median).add(cell.worst).add(cell.ratio);
        table.add(cell.change).add(cell.interval.low).add(cell.interval.high);
        table.add(static_cast<std::int64_t>(cell.count)).add(static_cast<std::int64_t>(row.runs));
        table.add(static_cast<std::int64_t>(row.successes)).end_row();
      }
    }
  }
  return table;
}

Json case_json(const AblationCase& each) {
  Json variants = Json::object();
  for (const AblationRow& row : each.rows) {
    Json scores = Json::object();
    for (std::size_t i = 0; i < kAblationCount; ++i) {
      const PairedStatistics& cell = row.cells[i];
      scores[ablation_scores()[i].key] = {{"median", json_of(cell.median)},
                                          {"worst", json_of(cell.worst)},
                                          {"ratio", json_of(cell.ratio)},
                                          {"change", cell.change},
                                          {"change_low", json_of(cell.interval.low)},
                                          {"change_high", json_of(cell.interval.high)},
                                          {"count", cell.count}};
    }
    const Interval interval = wilson_interval(row.successes, row.runs);
    variants[row.label] = {{"runs", row.runs},
                           {"successes", row.successes},
                           {"success_low", json_of(interval.low)},
                           {"success_high", json_of(interval.high)},
                           {"successes_1_percent", row.strict.count},
                           {"mcnemar_p", row.success_test.p},
                           {"scores", std::move(scores)}};
  }
  return {{"scenario", each.scenario}, {"variants", std::move(variants)}};
}

Json ablation_json(const Ablation& ablation, const Suite& suite) {
  Json json = {{"schema", kAblationSchema},      {"version", AIMS_VERSION},
               {"code", code_version()},         {"complete", suite.complete},
               {"estimator", ablation.complete}, {"effects", Json::object()},
               {"scenarios", Json::array()}};
  for (const AblationEffect& each : ablation.effects) {
    Json ratios = Json::object();
    for (std::size_t i = 0; i < kAblationCount; ++i) {
      ratios[ablation_scores()[i].key] = json_of(each.ratios[i]);
    }
    json["effects"][each.label] = {{"settings", each.changes},
                                   {"mean_ratio", std::move(ratios)},
                                   {"largest_ate_ratio", json_of(each.worst_ratio)},
                                   {"largest_in", each.worst_scenario}};
  }
  json["invalid"] = invalid_json(suite);
  for (const AblationCase& each : ablation.cases) json["scenarios"].push_back(case_json(each));
  return json;
}

}  // namespace

TextTable effect_table(const Ablation& ablation) {
  TextTable table;
  table.header = {"variant"};
  for (const Score& score : ablation_scores()) table.header.push_back(title_with_unit(score));
  table.header.insert(table.header.end(), {"largest of ATE yaw", "in"});
  for (const AblationEffect& each : ablation.effects) {
    std::vector<std::string> row = {each.label};
    for (const auto& ratio : each.ratios) row.push_back(ratio_text(ratio));
    row.insert(row.end(), {ratio_text(each.worst_ratio), each.worst_scenario});
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable case_table(const AblationCase& each) {
  TextTable table;
  table.header = {"variant"};
  for (const Score& score : ablation_scores()) table.header.push_back(title_with_unit(score));
  for (const Score& score : success_scores()) table.header.emplace_back(score.title);
  table.header.emplace_back("McNemar's p");
  for (const AblationRow& row : each.rows) {
    std::vector<std::string> cells = {row.label};
    for (std::size_t i = 0; i < kAblationCount; ++i) {
      cells.push_back(cell_text(row.cells[i], ablation_scores()[i].digits));
    }
    cells.push_back(SuccessRate{row.successes, row.runs}.text());
    cells.push_back(row.strict.text());
    cells.push_back(fmt::format("{:.3g}", row.success_test.p));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Result<void> write_ablation(const Ablation& ablation, const Suite& suite,
                            const std::filesystem::path& folder) {
  return write_report({.name = "ablation",
                       .markdown = markdown_of(ablation, suite),
                       .csv = csv_of(ablation),
                       .json = ablation_json(ablation, suite)},
                      folder);
}

}  // namespace aims
