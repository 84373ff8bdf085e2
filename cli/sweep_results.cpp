// SPDX-License-Identifier: BSD-3-Clause
#include "cli/sweep_results.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include "bench/tuning/point_table.hpp"
#include "bench/tuning/sweep_summary.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostShown = 40;  ///< points that are listed one by one

}  // namespace

Result<void> write_results(const MergedSweep& sweep, const Objective& objective,
                           const fs::path& out) {
  std::error_code ignored;
  fs::create_directories(out, ignored);
  auto written = write_sqlite(sweep, out / "sweep.sqlite");
  if (written) written = write_sweep_csv(sweep, out / "sweep.csv");
  if (!written) return written;
  const auto summary = write_sweep_summary(sweep, objective, out);
  if (!summary) print_out("note: no sweep.md: {}\n", summary.error().message);
  return {};
}

Json points_json(const MergedSweep& sweep, const Objective& objective) {
  const auto responses = sweep_responses(sweep, objective.score);
  if (!responses || responses->empty()) return {};
  Json json = Json::array();
  for (const SweepResponse& each : *responses) json.push_back(response_json(each, objective));
  return json;
}

void print_points(const MergedSweep& sweep, const Objective& objective) {
  const auto responses = sweep_responses(sweep, objective.score);
  if (!responses || responses->empty()) return;
  TextTable table = point_table(*responses, objective);
  if (table.rows.empty()) return;
  const std::size_t points = table.rows.size();
  table.rows.resize(std::min(points, kMostShown));
  print_out("{}", to_text(table));
  if (points > kMostShown) print_out("and {} more points\n", points - kMostShown);
  std::size_t incomplete = 0;
  for (const SweepResponse& each : *responses) incomplete += each.incomplete;
  if (incomplete > 0) print_out("{} points are not complete\n", incomplete);
  print_out("objective: {}\n\n", text_of(objective_for(objective, responses->front().table)));
}

}  // namespace aims
