// SPDX-License-Identifier: BSD-3-Clause
#include "cli/sweep_results.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "bench/tuning/point_table.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "bench/tuning/sweep_summary.hpp"
#include "cli/terminal.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostShown = 40;  ///< points of an estimator that are listed

}  // namespace

Result<void> write_results(const MergedSweep& sweep, const Objective& objective,
                           const fs::path& out) {
  std::error_code ignored;
  fs::create_directories(out, ignored);
  auto written = write_sqlite(sweep, out / "sweep.sqlite");
  if (written) written = write_sweep_csv(sweep, out / "sweep.csv");
  if (written) written = write_objective(objective, out);
  if (!written) return written;
  const auto summary = write_sweep_summary(sweep, objective, out);
  if (!summary) print_out("note: no sweep.md: {}\n", summary.error().message);
  return {};
}

Json points_json(const MergedSweep& sweep, const Objective& objective) {
  const auto responses = sweep_responses(sweep, objective.score);
  if (!responses || responses->empty()) return {};
  return json_array(*responses, [&objective](const SweepResponse& each) {
    return response_json(each, objective);
  });
}

void print_points(const MergedSweep& sweep, const Objective& objective) {
  const auto responses = sweep_responses(sweep, objective.score);
  if (!responses || responses->empty()) return;
  std::size_t points = 0;
  for (const SweepResponse& each : *responses) {
    points += other_points(each.table) + (each.table.default_runs.empty() ? 0 : 1);
  }
  const TextTable table = point_table(*responses, objective, kMostShown);
  if (table.rows.empty()) return;
  print_out("{}", to_text(table));
  if (points > table.rows.size()) {
    print_out("and {} of larger objective, on the page and in sweep.csv\n",
              counted(points - table.rows.size(), "point"));
  }
  std::size_t incomplete = 0;
  for (const SweepResponse& each : *responses) incomplete += each.incomplete;
  if (incomplete > 0) {
    print_out("{} {} not complete\n", counted(incomplete, "point"), incomplete == 1 ? "is" : "are");
  }
  if (const std::string open = unstarted_text(sweep); !open.empty()) print_out("{}\n", open);
  std::vector<std::string> texts;
  for (const SweepResponse& each : *responses) {
    texts.push_back(text_of(objective_for(objective, each.table)));
  }
  const bool alike = std::ranges::count(texts, texts.front()) == std::ssize(texts);
  for (std::size_t i = 0; i < (alike ? 1 : texts.size()); ++i) {
    print_out("objective{}: {}\n", alike ? "" : " of " + (*responses)[i].estimator, texts[i]);
  }
  print_out("\n");
}

}  // namespace aims
