// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/estimate_pictures.hpp"

#include <fmt/format.h>

#include "render/results/estimator_pictures.hpp"
#include "render/results/trajectory_pictures.hpp"

namespace aims {

namespace fs = std::filesystem;

Result<void> draw_estimate(const EstimateResult& result, const fs::path& folder,
                           const DrawObserver& observer) {
  const std::string title = result.bag.stem().string();
  Result<void> drawn;
  for (const EstimatorOutcome& each : result.estimators) {
    if (!drawn) break;
    announce(observer, folder / (each.name + "-map-top.png"));
    drawn = draw_map(title, each, folder);
  }
  const std::vector<WaypointTime> none;
  if (drawn) {
    announce(observer, folder / "degeneracy.png");
    drawn = draw_degeneracy(title, fmt::format("{:.0f} s recorded", result.recorded_s),
                            result.estimators, result.scores ? result.scores->waypoint_times : none,
                            folder);
  }
  if (drawn && result.scores) drawn = draw_trajectory_pictures(*result.scores, folder, observer);
  return drawn;
}

}  // namespace aims
