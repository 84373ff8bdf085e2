// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "bench/run/code_version.hpp"
#include "bench/scoring/columns.hpp"
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
  if (!suite.complete) text += "\n**Interrupted: of the finished runs alone.**\n";
  text += "\n## Over all instants\n\n" + to_markdown(consistency_table(study));
  text +=
      "\n## At the end\n\nRoot mean squares over seeds [m].\n\n" + to_markdown(end_table(study));
  for (const std::string& line : left_out_lines(suite)) text += fmt::format("\n- {}\n", line);
  return text + markdown_list(suite.failures);
}

CsvTable csv_of(const ConsistencyStudy& study) {
  CsvTable table({"scenario", "estimator", "t_s", "runs", "nees", "nees_low", "nees_high", "inside",
                  "fraction_in_2_sigma", "error_rms_m", "sigma_rms_m", "bound_rms_m",
                  "leg_bound_rms_m"});
  for (const ConsistencyCase& each : study) {
    for (const ConsistencyInstant& at : each.result.instants) {
      table.add(each.scenario).add(each.estimator).add(at.time_s).add(at.covered.runs);
      table.add(at.nees).add(at.bounds.low).add(at.bounds.high).add(at.inside());
      table.add(at.covered.fraction);
      table.add(at.error_rms_m).add(at.sigma_rms_m).add(at.bound_rms_m).add(at.leg_bound_rms_m);
      table.end_row();
    }
  }
  return table;
}

Json interval_json(const Interval& interval) {
  return Json::array({json_of(interval.low), json_of(interval.high)});
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

/// Over time: what consistency.csv holds of the case.
Json series_json(const std::vector<ConsistencyInstant>& instants) {
  Json series;
  for (const ConsistencyInstant& at : instants) {
    series["t_s"].push_back(at.time_s);
    series["nees"].push_back(json_of(at.nees));
    series["nees_low"].push_back(json_of(at.bounds.low));
    series["nees_high"].push_back(json_of(at.bounds.high));
    series["error_rms_m"].push_back(json_of(at.error_rms_m));
    series["sigma_rms_m"].push_back(json_of(at.sigma_rms_m));
    series["bound_rms_m"].push_back(json_of(at.bound_rms_m));
    series["leg_bound_rms_m"].push_back(json_of(at.leg_bound_rms_m));
  }
  return series;
}

/// The first run over time, as an example; null without one.
Json example_json(const ConsistencyCase& each) {
  for (std::size_t i = 0; i < each.runs.size(); ++i) {
    if (each.runs[i].empty()) continue;
    Json series;
    for (const ConsistencySample& sample : each.runs[i]) {
      series["t_s"].push_back(sample.time_s);
      series["error_m"].push_back(json_of(sample.error_m));
      series["two_sigma_m"].push_back(sample.sigma_m ? Json(2.0 * *sample.sigma_m) : Json());
    }
    return {{"seed", each.seeds[i]}, {"series", std::move(series)}};
  }
  return {};
}

Json case_json(const ConsistencyCase& each) {
  const Consistency& r = each.result;
  Json runs = Json::array();
  for (std::size_t i = 0; i < each.runs.size(); ++i) {
    if (each.runs[i].empty()) continue;
    const ConsistencySample& end = each.runs[i].back();
    runs.push_back({{"seed", each.seeds[i]},
                    {"end_t_s", end.time_s},
                    {"end_error_m", json_of(end.error_m)},
                    {"end_sigma_m", json_of(end.sigma_m)}});
  }
  return {{"scenario", each.scenario},
          {"estimator", each.estimator},
          {"runs", r.runs},
          {"instants", r.judged},
          {"inside_fraction", json_of(r.inside_fraction)},
          {"above_fraction", json_of(r.above_fraction)},
          {"mean_nees", json_of(r.mean_nees)},
          {"mean_nees_interval", interval_json(r.mean_nees_interval)},
          {"two_sigma", coverage_json(r.two_sigma)},
          {"error_rms_m", json_of(r.error_rms_m)},
          {"efficiency", json_of(r.efficiency)},
          {"end", end_json(r.end)},
          {"series", series_json(r.instants)},
          {"example", example_json(each)},
          {"seeds", std::move(runs)}};
}

Json study_json(const ConsistencyStudy& study, const Suite& suite) {
  Json json = {{"schema", kConsistencySchema},
               {"version", AIMS_VERSION},
               {"code", code_version()},
               {"complete", suite.complete},
               {"cases", Json::array()}};
  json["invalid"] = invalid_json(suite);
  for (const ConsistencyCase& each : study) json["cases"].push_back(case_json(each));
  return json;
}

}  // namespace

TextTable consistency_table(const ConsistencyStudy& study) {
  TextTable table;
  table.header = {"scenario", "estimator", "seeds",   "mean NEES",       "inside",
                  "above",    "2 sigma",   "error m", "bound over error"};
  for (const ConsistencyCase& each : study) {
    const Consistency& r = each.result;
    std::string nees = number_text(r.mean_nees, "{:.2f}");
    if (r.mean_nees_interval.low) nees += " " + interval_text(r.mean_nees_interval, "{:.2f}");
    table.rows.push_back(
        {each.scenario, each.estimator, std::to_string(r.runs), nees,
         number_text(r.inside_fraction, "{:.2f}"), number_text(r.above_fraction, "{:.2f}"),
         number_text(r.two_sigma.fraction, "{:.2f}"), fmt::format("{:.3f}", r.error_rms_m),
         number_text(r.efficiency, "{:.2f}")});
  }
  return table;
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
