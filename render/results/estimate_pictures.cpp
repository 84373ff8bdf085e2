// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <utility>

#include "bench/scoring/tables.hpp"
#include "core/files/tum.hpp"
#include "render/results/estimator_pictures.hpp"
#include "render/results/pictures.hpp"

namespace aims {

namespace fs = std::filesystem;

namespace {

/// The outcome with its trajectory, and of its scans the series that are drawn, where they are in
/// the folder of the result.
Result<EstimatorOutcome> drawn_part(const EstimateResult& result, const EstimatorOutcome& outcome) {
  if (result.folder.empty()) return outcome;
  EstimatorOutcome part;
  part.name = outcome.name;
  part.map = outcome.map;
  auto trajectory = read_tum(result.folder / (part.name + ".tum"), PoseRules::kAsGiven);
  if (!trajectory) return tl::unexpected(trajectory.error());
  part.result.trajectory = std::move(*trajectory);
  auto scans = read_diagnostics(result.folder / (part.name + ".diagnostics.csv"), drawn_series());
  if (!scans) return tl::unexpected(scans.error());
  part.result.diagnostics = std::move(*scans);
  return part;
}

}  // namespace

Result<void> draw_estimate(const EstimateResult& result, const fs::path& folder,
                           const DrawObserver& observer) {
  const std::string title = result.bag.stem().string();
  const std::string subtitle = fmt::format("{:.0f} s recorded", result.recorded_s);
  const std::vector<WaypointTime> none;
  const std::vector<WaypointTime>& events = result.scores ? result.scores->waypoint_times : none;
  announce(observer, folder / "degeneracy.png");
  bool has_degeneracy = false;  // the first estimator's that reports it
  for (const EstimatorOutcome& each : result.estimators) {
    const auto part = drawn_part(result, each);
    if (!part) return tl::unexpected(part.error());
    if (!has_degeneracy) {
      const auto drawn = draw_degeneracy(title, subtitle, *part, events, folder);
      if (!drawn) return tl::unexpected(drawn.error());
      has_degeneracy = *drawn;
    }
    announce(observer, folder / (each.name + "-map-top.png"));
    if (auto drawn = draw_map(title, *part, folder); !drawn) return drawn;
  }
  if (!result.scores) return {};
  return draw_trajectory_pictures(*result.scores, folder, observer);
}

}  // namespace aims
