// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "bench/studies/success_pairs.hpp"
#include "bench/studies/suite_summary.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

bool ran(const SuiteCase& each, const std::string& estimator) {
  return finished(each.runs, estimator) > 0;
}

/// The cell of an estimator without a valid run; empty when it has none at all.
std::string invalid_cell(const SuiteCase& each, const std::string& estimator) {
  const bool any = std::ranges::any_of(
      each.runs, [&](const RunRecord& run) { return !estimator_in(run, estimator).is_null(); });
  return any ? "invalid" : "";
}

std::string headline_cell(const SuiteCase& each, const std::string& estimator, const Score& score) {
  if (!ran(each, estimator)) {
    const bool failed = success_rate(each.runs, estimator).runs > 0;
    return failed ? "failed" : invalid_cell(each, estimator);
  }
  const ScoreStatistics summary = statistics_of(each.runs, estimator, score.key);
  if (!summary.median) return "-";
  std::string text = fmt::format("{:.{}f}", *summary.median, score.digits);
  const Interval interval = median_interval(each.runs, estimator, score.key);
  if (interval.low) {
    text += fmt::format(" [{:.{}f}, {:.{}f}] {:.{}f}", *interval.low, score.digits, *interval.high,
                        score.digits, *summary.worst, score.digits);
  }
  if (const std::size_t runs = finished(each.runs, estimator); summary.count < runs) {
    text += fmt::format(" ({} of {})", summary.count, runs);
  }
  return text + part_mark(any_partial(each.runs, estimator));
}

/// Whether a table of scores has the mark " part".
bool has_part(const Suite& suite) {
  const std::vector<std::string> estimators = estimators_of(suite);
  return std::ranges::any_of(suite.cases, [&](const SuiteCase& each) {
    return std::ranges::any_of(estimators, [&](const std::string& estimator) {
      return ran(each, estimator) && any_partial(each.runs, estimator);
    });
  });
}

template <class Cell>
TextTable matrix(const Suite& suite, const Cell& cell) {
  TextTable table;
  table.header = {"scenario"};
  const std::vector<std::string> estimators = estimators_of(suite);
  table.header.insert(table.header.end(), estimators.begin(), estimators.end());
  for (const SuiteCase& each : suite.cases) {
    std::vector<std::string> row = {each.scenario.name};
    for (const std::string& estimator : estimators) row.push_back(cell(each, estimator));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Scenario, family, level and seed of a row.
void add_start(const Scenario& scenario, std::uint64_t seed, CsvTable& table) {
  table.add(scenario.name).add(scenario.family);
  if (scenario.family.empty()) {
    table.add_empty();
  } else {
    table.add(scenario.level);
  }
  table.add(seed);
}

std::string expectations_markdown(const Suite& suite) {
  std::size_t count = 0;
  std::string text;
  for (const SuiteCase& each : suite.cases) {
    count += each.expectations.size();
    for (const ExpectationCheck& check : failed(each.expectations)) {
      text += fmt::format("- {}; again: `{}`\n", text_of(each.scenario, check),
                          reproducing_command(each.scenario, check));
    }
  }
  if (count == 0) return "None applies to the estimators that ran.\n";
  return text.empty() ? fmt::format("All {} hold.\n", count) : text;
}

std::string success_markdown(const Suite& suite) {
  std::string text =
      "\n## Success\n\nRuns whose position error stayed within a percentage of the distance "
      "travelled, of all valid\nones, with the 95 % Wilson interval.\n";
  for (const Score& score : success_scores()) {
    text += fmt::format("\n### Success {}\n\n{}", score.title,
                        to_markdown(success_table(suite, score)));
  }
  const TextTable pairs = success_pairs_table(suite, true);
  if (pairs.rows.empty()) return text;
  return text +
         "\n### Pairs of estimators\n\nSequences on which one alone is a success; seeds on which "
         "one "
         "succeeds on more sequences;\np: sign test over seeds, not corrected for the number of "
         "pairs.\n\n" +
         to_markdown(pairs);
}

std::string failures_markdown(const Suite& suite) {
  std::string text = markdown_list(suite.failures);
  for (const std::string& line : left_out_lines(suite)) text += fmt::format("- {}\n", line);
  return text.empty() ? "Everything ran, and every run is valid.\n" : text;
}

/// The headline scores; those of a data set are led by its own.
std::vector<Score> scores_of(const Suite& suite) {
  std::vector<Score> scores(headline_scores().begin(), headline_scores().end());
  const std::string& lead = suite.lead_score;
  if (lead.empty()) return scores;
  const auto listed = std::ranges::find(scores, lead, &Score::key);
  if (listed != scores.end()) {
    std::rotate(scores.begin(), listed, listed + 1);
  } else {
    scores.insert(scores.begin(), score_at(lead));
    Score& first = scores.front();
    if (lead != first.key || first.title.empty()) first.title = lead;
    first.key = lead.c_str();
  }
  scores.front().unit = suite.lead_unit;
  return scores;
}

}  // namespace

TextTable headline_table(const Suite& suite, const Score& score) {
  return matrix(suite, [&](const SuiteCase& each, const std::string& estimator) {
    return headline_cell(each, estimator, score);
  });
}

TextTable success_table(const Suite& suite, const Score& score) {
  return matrix(suite, [&](const SuiteCase& each, const std::string& estimator) {
    const SuccessRate rate = success_rate(each.runs, estimator, score.key);
    if (rate.runs > 0) return rate.text();
    // The truth may say nothing of a success.
    return ran(each, estimator) ? std::string("-") : invalid_cell(each, estimator);
  });
}

TextTable success_pairs_table(const Suite& suite, bool all) {
  TextTable table;
  table.header = {"estimators", "sequences", "seeds"};
  for (const Score& score : success_scores()) {
    table.header.push_back(fmt::format("{}: first alone", score.title));
    table.header.insert(table.header.end(), {"second alone", "seeds for first, second", "p"});
  }
  for (const SuccessPair& pair : success_pairs(suite)) {
    std::vector<std::string> row = {fmt::format("{}, {}", pair.first, pair.second),
                                    std::to_string(pair.tests[0].sequences),
                                    std::to_string(pair.tests[0].seeds)};
    std::size_t different = 0;
    for (const SuccessTest& test : pair.tests) {
      row.push_back(std::to_string(test.only_first));
      row.push_back(std::to_string(test.only_second));
      row.push_back(fmt::format("{}, {}", test.by_seed.only_first, test.by_seed.only_second));
      row.push_back(fmt::format("{:.3g}", test.by_seed.p));
      different += test.only_first + test.only_second;
    }
    if (all || different > 0) table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable breaks_table(const std::vector<FamilyResult>& families) {
  TextTable table;
  table.header = {"family", "unit", "mildest", "not told apart"};
  if (families.empty()) return table;
  for (const FamilyCurve& curve : families.front().curves) table.header.push_back(curve.estimator);
  for (const FamilyResult& family : families) {
    std::vector<std::string> row = {family.name, family.level_unit,
                                    fmt::format("{:g}", family.mildest), alike_text(family)};
    for (const FamilyCurve& curve : family.curves) {
      row.push_back(
          curve.breaks_at.empty() ? "-" : fmt::format("{:g}", fmt::join(curve.breaks_at, ", ")));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string suite_markdown(const Suite& suite, const std::vector<FamilyResult>& families) {
  std::string text = "# Suite\n\n";
  if (!suite.settings.empty()) text += settings_markdown(suite.settings) + "\n";
  if (!suite.complete) text += fmt::format("{}\n", kInterruptedNote);
  text +=
      "Each cell: median [95 % bootstrap interval of the median] worst, over seeds. Below about\n"
      "ten seeds the intervals are coarse and too narrow; with one seed there are none.\n";
  if (has_part(suite)) text += kPartLegend;
  for (const Score& score : scores_of(suite)) {
    text += fmt::format("\n## {} [{}]\n\n{}", score.title, score.unit,
                        to_markdown(headline_table(suite, score)));
  }
  text += success_markdown(suite);
  if (!families.empty()) {
    text += fmt::format(
        "\n## Breakdown level\n\nThe first level, going away from the mildest, where less than "
        "half of "
        "the runs succeed or the median ATE yaw exceeds both twice that at the mildest and {:g} % "
        "of the route's length.\nNot told apart: levels that do not differ from the mildest by the "
        "sign-flip test over seeds; one of them may be as mild.\n\n{}",
        100.0 * kMinBreakError, to_markdown(breaks_table(families)));
  }
  text += "\n## Expectations\n\n" + expectations_markdown(suite);
  text += "\n## Failures\n\n" + failures_markdown(suite);
  return text;
}

std::string suite_latex(const Suite& suite) {
  std::string text;
  for (const Score& score : scores_of(suite)) {
    text += fmt::format("% {} [{}]: median [95 % bootstrap interval] worst\n{}\n", score.title,
                        score.unit, to_latex(headline_table(suite, score)));
  }
  for (const Score& score : success_scores()) {
    text += fmt::format("% success {} of the distance, 95 % Wilson interval\n{}\n", score.title,
                        to_latex(success_table(suite, score)));
  }
  return text;
}

CsvTable suite_csv(const Suite& suite) {
  CsvTable table({"scenario", "family", "level", "seed", "estimator", "score", "value"});
  for (const SuiteCase& each : suite.cases) {
    for (const RunRecord& run : each.runs) {
      if (!is_valid_run(run)) {
        add_start(each.scenario, run.seed, table);
        table.add("").add("robot.valid").add(0.0).end_row();
        continue;
      }
      for (const std::string& estimator : labels_of(each.scenario.run)) {
        for (const std::string& key : score_keys(run, estimator)) {
          if (is_timing(key)) continue;
          add_start(each.scenario, run.seed, table);
          table.add(estimator).add(key).add(find_score(run, estimator, key)).end_row();
        }
      }
    }
    for (const RunFailure& failed : suite.failures) {
      if (!failed.seed || failed.scenario != each.scenario.name) continue;
      add_start(each.scenario, *failed.seed, table);
      table.add(failed.estimator).add("failed").add(1.0).end_row();
    }
  }
  return table;
}

CsvTable timings_csv(const Suite& suite) {
  CsvTable table({"scenario", "seed", "estimator", "simulated_s", "wall_s", "wall_per_scan_ms",
                  "cpu_per_scan_ms"});
  for (const SuiteCase& each : suite.cases) {
    for (const RunRecord& run : each.runs) {
      for (const std::string& estimator : labels_of(each.scenario.run)) {
        if (estimator_in(run, estimator).is_null()) continue;
        table.add(each.scenario.name).add(run.seed).add(estimator);
        table.add(value_in(run.scores, "simulated_s", 0.0));
        table.add(value_in(value_in(run.scores, "wall_s", Json()), estimator, 0.0));
        table.add(find_score(run, estimator, "time_per_scan_ms.mean"));
        table.add(find_score(run, estimator, "cpu_per_scan_ms.mean")).end_row();
      }
    }
  }
  return table;
}

}  // namespace aims
