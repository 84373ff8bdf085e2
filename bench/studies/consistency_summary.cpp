// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "bench/scoring/report.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/studies/consistency_study.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kConsistencyIntroduction =
    "# Do errors along the weak axis agree with the stated covariance?\n"
    "\n"
    "Error: estimated minus true position along each scan's weakest axis by the truth, the\n"
    "estimate aligned to the truth at its first pose; one scan per second. NEES: its square over\n"
    "the variance that the estimator states along that axis; the mean over seeds is 1 when that "
    "is\n"
    "right, above 1 when it is overconfident. Inside: fraction of the instants at which that mean\n"
    "lies within its 95 % chi-square bounds (N seeds, N degrees of freedom); above: fraction "
    "beyond\n"
    "the upper bound. Instants that fewer than half of the runs reach are left out. 2 sigma:\n"
    "fraction of runs whose error is within twice the stated deviation, over all instants and at\n"
    "the end (with its 95 % Wilson interval). Bound over error: accumulated Cramer-Rao bound of "
    "all\n"
    "sensors over the error, rms over seeds; 0.5 is an error of twice the bound. The leg bound is\n"
    "that of IMU and legs alone; it models neither slip nor rolling feet, so that real legs are\n"
    "worse.\n";

std::string markdown_of(const ConsistencyStudy& study, const Suite& suite) {
  std::string text = kConsistencyIntroduction;
  if (!suite.complete) text += fmt::format("\n{}", kInterruptedNote);
  text += "\n## Over all instants\n\n" + to_markdown(consistency_table(study));
  text +=
      "\n## At the end\n\nRoot mean squares over seeds [m].\n\n" + to_markdown(end_table(study));
  for (const std::string& line : left_out_lines(suite)) text += fmt::format("\n- {}\n", line);
  return text + markdown_list(suite.failures);
}

/// Over time; those of consistency.csv alone have no key in consistency.json.
TableColumns<ConsistencyInstant> instant_columns(bool in_csv) {
  using Instant = ConsistencyInstant;
  return {{"t_s", "", &Instant::time_s},
          {in_csv ? "runs" : "", "", [](const Instant& at) { return at.covered.runs; }},
          {"nees", "", &Instant::nees},
          {"nees_low", "", [](const Instant& at) { return at.bounds.low; }},
          {"nees_high", "", [](const Instant& at) { return at.bounds.high; }},
          {in_csv ? "inside" : "", "", &Instant::inside},
          {in_csv ? "fraction_in_2_sigma" : "", "",
           [](const Instant& at) { return at.covered.fraction; }},
          {"error_rms_m", "", &Instant::error_rms_m},
          {"sigma_rms_m", "", &Instant::sigma_rms_m},
          {"bound_rms_m", "", &Instant::bound_rms_m},
          {"leg_bound_rms_m", "", &Instant::leg_bound_rms_m}};
}

CsvTable csv_of(const ConsistencyStudy& study) {
  const auto columns = instant_columns(true);
  CsvTable table(csv_header(columns, {"scenario", "estimator"}));
  for (const ConsistencyCase& each : study) {
    for (const ConsistencyInstant& at : each.result.instants) {
      table.add(each.scenario).add(each.estimator);
      add_cells(columns, at, table);
      table.end_row();
    }
  }
  return table;
}

Json coverage_json(const Coverage& coverage) {
  return {{"inside", coverage.inside},
          {"of", coverage.runs},
          {"fraction", json_of(coverage.fraction)},
          {"interval", interval_json(coverage.interval)}};
}

Json end_json(const ConsistencyInstant& end) {
  return {{"nees", json_of(end.nees)},
          {"nees_bounds", interval_json(end.bounds)},
          {"two_sigma", coverage_json(end.covered)},
          {"error_rms_m", json_of(end.error_rms_m)},
          {"sigma_rms_m", json_of(end.sigma_rms_m)},
          {"bound_rms_m", json_of(end.bound_rms_m)},
          {"leg_bound_rms_m", json_of(end.leg_bound_rms_m)},
          {"efficiency", json_of(end.efficiency)}};
}

/// The first run over time, as an example; null without one.
Json example_json(const ConsistencyCase& each) {
  using Sample = ConsistencySample;
  static const TableColumns<Sample> columns = {
      {"t_s", "", &Sample::time_s},
      {"error_m", "", &Sample::error_m},
      {"two_sigma_m", "",
       [](const Sample& at) { return at.sigma_m ? Json(2.0 * *at.sigma_m) : Json(); }}};
  for (std::size_t i = 0; i < each.runs.size(); ++i) {
    if (each.runs[i].empty()) continue;
    return {{"seed", each.seeds[i]}, {"series", columns_json(columns, each.runs[i])}};
  }
  return {};
}

/// The last instant of each run.
Json ends_json(const ConsistencyCase& each) {
  Json runs = Json::array();
  for (std::size_t i = 0; i < each.runs.size(); ++i) {
    if (each.runs[i].empty()) continue;
    const ConsistencySample& end = each.runs[i].back();
    runs.push_back({{"seed", each.seeds[i]},
                    {"end_t_s", end.time_s},
                    {"end_error_m", json_of(end.error_m)},
                    {"end_sigma_m", json_of(end.sigma_m)}});
  }
  return runs;
}

std::string nees_text(const Consistency& result) {
  std::string text = number_text(result.mean_nees, "{:.2f}");
  if (result.mean_nees_interval.low)
    text += " " + interval_text(result.mean_nees_interval, "{:.2f}");
  return text;
}

/// Of a case in consistency.json and, where they have a title, in the table.
const TableColumns<ConsistencyCase>& case_columns() {
  using Case = ConsistencyCase;
  static const TableColumns<Case> columns = {
      {"scenario", "scenario", &Case::scenario},
      {"estimator", "estimator", &Case::estimator},
      {"runs", "seeds", [](const Case& c) { return c.result.runs; }},
      {"", "mean NEES", [](const Case& c) { return nees_text(c.result); }},
      {"instants", "", [](const Case& c) { return c.result.judged; }},
      {"inside_fraction", "inside", [](const Case& c) { return c.result.inside_fraction; },
       "{:.2f}"},
      {"above_fraction", "above", [](const Case& c) { return c.result.above_fraction; }, "{:.2f}"},
      {"mean_nees", "", [](const Case& c) { return c.result.mean_nees; }},
      {"mean_nees_interval", "",
       [](const Case& c) { return interval_json(c.result.mean_nees_interval); }},
      {"two_sigma", "", [](const Case& c) { return coverage_json(c.result.two_sigma); }},
      {"", "2 sigma", [](const Case& c) { return c.result.two_sigma.fraction; }, "{:.2f}"},
      {"error_rms_m", "error m", [](const Case& c) { return c.result.error_rms_m; }, "{:.3f}"},
      {"efficiency", "bound over error", [](const Case& c) { return c.result.efficiency; },
       "{:.2f}"},
      {"end", "", [](const Case& c) { return end_json(c.result.end); }},
      {"series", "",
       [](const Case& c) { return columns_json(instant_columns(false), c.result.instants); }},
      {"example", "", example_json},
      {"seeds", "", ends_json}};
  return columns;
}

Json study_json(const ConsistencyStudy& study, const Suite& suite) {
  Json json = study_head(kConsistencySchema, suite);
  json["cases"] = rows_json(case_columns(), study);
  json["invalid"] = invalid_json(suite);
  return json;
}

}  // namespace

TextTable consistency_table(const ConsistencyStudy& study) {
  return rows_table(case_columns(), study);
}

TextTable end_table(const ConsistencyStudy& study) {
  TextTable table;
  table.header = {"scenario",  "estimator", "error",   "stated",    "bound",
                  "leg bound", "NEES",      "of 1 in", "in 2 sigma"};
  for (const ConsistencyCase& each : study) {
    const ConsistencyInstant& end = each.result.end;
    std::string inside = fmt::format("{}/{}", end.covered.inside, end.covered.runs);
    if (end.covered.interval.low) inside += " " + interval_text(end.covered.interval, "{:.2f}");
    table.rows.push_back(
        {each.scenario, each.estimator, fmt::format("{:.3f}", end.error_rms_m),
         number_text(end.sigma_rms_m, "{:.3f}"), fmt::format("{:.3f}", end.bound_rms_m),
         fmt::format("{:.3f}", end.leg_bound_rms_m), number_text(end.nees, "{:.2f}"),
         interval_text(end.bounds, "{:.2f}"), inside});
  }
  return table;
}

Result<void> write_consistency(const ConsistencyStudy& study, const Suite& suite,
                               const fs::path& folder) {
  return write_report({.name = "consistency",
                       .markdown = markdown_of(study, suite),
                       .csv = csv_of(study),
                       .json = study_json(study, suite)},
                      folder);
}

}  // namespace aims
