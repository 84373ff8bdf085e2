// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cli/sweep_points.hpp"

#include <algorithm>

#include "bench/cli/terminal.hpp"
#include "bench/tuning/point_table.hpp"

namespace aims {
namespace {

constexpr std::size_t kMostShown = 40;  ///< points that are listed one by one

}  // namespace

void print_points(const MergedSweep& sweep, const std::string& score) {
  const auto responses = sweep_responses(sweep, score);
  if (!responses) return;
  TextTable table = point_table(*responses, score);
  if (table.rows.empty()) return;
  const std::size_t points = table.rows.size();
  table.rows.resize(std::min(points, kMostShown));
  print_out("{}", to_text(table));
  if (points > kMostShown) print_out("and {} more points\n", points - kMostShown);
  std::size_t incomplete = 0;
  for (const SweepResponse& each : *responses) incomplete += each.incomplete;
  if (incomplete > 0) print_out("{} points are not complete\n", incomplete);
  print_out("\n");
}

}  // namespace aims
