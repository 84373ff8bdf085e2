// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/consistency_pictures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "render/plots/time_plot.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

TimePanel nees_panel(const Consistency& result) {
  TimePanel panel{"Mean NEES over seeds, and the 95 % bounds of a consistent filter",
                  "NEES [-]",
                  {{"mean over seeds", {}}, {"lower bound", {}}, {"upper bound", {}}},
                  true,
                  false};
  for (const ConsistencyInstant& at : result.instants) {
    if (!at.nees) continue;
    panel.series[0].points.emplace_back(at.time_s, *at.nees);
    panel.series[1].points.emplace_back(at.time_s, *at.bounds.low);
    panel.series[2].points.emplace_back(at.time_s, *at.bounds.high);
  }
  return panel;
}

TimePanel spread_panel(const Consistency& result) {
  TimePanel panel{"Root mean squares over seeds",
                  "error along the weak axis [m]",
                  {{"error", {}}, {"stated deviation", {}}, {"bound", {}}, {"bound of legs", {}}},
                  true,
                  false};
  for (const ConsistencyInstant& at : result.instants) {
    const double values[] = {at.error_rms_m, at.sigma_rms_m, at.bound_rms_m, at.leg_bound_rms_m};
    for (std::size_t i = 0; i < 4; ++i) {
      if (values[i] > 0.0) panel.series[i].points.emplace_back(at.time_s, values[i]);
    }
  }
  return panel;
}

/// One run: its error against twice what it states.
TimePanel run_panel(const ConsistencyCase& each, std::size_t run) {
  TimePanel panel{fmt::format("Seed {}", each.seeds[run]),
                  "error along the weak axis [m]",
                  {{"size of the error", {}}, {"2 sigma", {}}},
                  false,
                  true};
  for (const ConsistencySample& sample : each.runs[run]) {
    panel.series[0].points.emplace_back(sample.time_s, std::abs(sample.error_m));
    if (sample.sigma_m) panel.series[1].points.emplace_back(sample.time_s, 2.0 * *sample.sigma_m);
  }
  return panel;
}

Result<void> draw(const ConsistencyCase& each, const fs::path& folder) {
  if (each.result.runs == 0) return {};
  TimePlot plot;
  plot.title =
      fmt::format("{}: consistency of {} along the weak axis", each.scenario, each.estimator);
  plot.subtitle = fmt::format(
      "{} seeds; NEES inside its bounds at {} % of {} instants", each.result.runs,
      each.result.inside_fraction ? fmt::format("{:.0f}", 100.0 * *each.result.inside_fraction) : "-",
      each.result.judged);
  plot.panels = {nees_panel(each.result), spread_panel(each.result)};
  for (std::size_t i = 0; i < each.runs.size(); ++i) {
    if (each.runs[i].empty()) continue;
    plot.panels.push_back(run_panel(each, i));
    break;
  }
  const std::string name = fmt::format("{}-{}-consistency", each.scenario, each.estimator);
  for (const char* ending : {".png", ".svg"}) {
    if (auto drawn = write_time_plot(folder / (name + ending), plot); !drawn) return drawn;
  }
  return {};
}

}  // namespace

Result<void> draw_consistency(const ConsistencyStudy& study, const fs::path& folder) {
  for (const ConsistencyCase& each : study) {
    if (auto drawn = draw(each, folder); !drawn) return drawn;
  }
  return {};
}

}  // namespace aims
