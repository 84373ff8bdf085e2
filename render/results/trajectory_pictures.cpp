// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "bench/scoring/start_anchor.hpp"
#include "render/plots/time_plot.hpp"
#include "render/plots/trajectory_plot.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

/// Pictures show trajectories at this spacing.
constexpr Duration kDrawnSpacing = 100 * kMillisecond;

/// The smallest errors that a logarithmic axis is to show.
constexpr double kLeastMetres = 1e-3;
constexpr double kLeastDegrees = 1e-2;

std::string subtitle_of(const TrajectoryScores& scores, const char* alignment) {
  const Trajectory& truth = scores.truth.trajectory;
  return fmt::format("{:.1f} m in {:.0f} s  ·  {}", path_length(truth),
                     to_seconds(truth.back().stamp - truth.front().stamp), alignment);
}

/// The reference points, or the ends of segments "from-to" that were given by their times.
std::vector<WaypointTime> points_of(const TrajectoryScores& scores) {
  std::vector<WaypointTime> points = scores.waypoint_times;
  if (!points.empty()) return points;
  for (const Segment& each : scores.segments) {
    const std::size_t dash = std::min(each.name.find('-'), each.name.size());
    points.push_back({each.name.substr(0, dash), each.begin});
    if (dash < each.name.size()) points.push_back({each.name.substr(dash + 1), each.end});
  }
  return points;
}

Result<void> draw_trajectories(const TrajectoryScores& scores, const std::filesystem::path& file) {
  TrajectoryPlot plot;
  plot.title = scores.truth.name + ": estimated trajectories";
  plot.subtitle = subtitle_of(scores, kHeadingFitted);
  plot.truth = thinned(scores.truth.trajectory, kDrawnSpacing);
  plot.waypoint_times = points_of(scores);
  for (const ScoredEstimate& each : scores.estimates) {
    plot.estimates.push_back(
        {each.given.name,
         heading_fitted(thinned(each.in_truth_frame, kDrawnSpacing), scores.truth.trajectory,
                        scores.scoring, each.scores.diverged_at)});
  }
  return write_trajectory_plot(file, plot);
}

double heading_error_deg(const PosePair& pair) {
  const double error = wrap_angle(yaw_of(pair.estimate.rotation) - yaw_of(pair.truth.rotation));
  return std::abs(error) * 180.0 / std::numbers::pi;
}

/// One quantity of each estimate over the time since the truth's start.
template <class Quantity>
TimePanel panel_of(const TrajectoryScores& scores, std::string title, std::string label,
                   double least, const Quantity& quantity) {
  TimePanel panel{std::move(title), std::move(label), {}, true, false};
  const Time start = scores.truth.trajectory.front().stamp;
  for (const ScoredEstimate& each : scores.estimates) {
    TimeSeries series{each.given.name, {}};
    const auto pairs = compared_pairs(thinned(each.in_truth_frame, kDrawnSpacing),
                                      scores.truth.trajectory, scores.scoring);
    for (const PosePair& pair : pairs) {
      series.points.emplace_back(to_seconds(pair.stamp - start), std::max(least, quantity(pair)));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

Result<void> draw_errors(const TrajectoryScores& scores, const std::filesystem::path& file) {
  const auto distance = [](const PosePair& pair) {
    return (pair.estimate.translation - pair.truth.translation).norm();
  };
  const auto height = [](const PosePair& pair) {
    return std::abs(pair.estimate.translation.z() - pair.truth.translation.z());
  };
  TimePlot plot;
  plot.of_estimators = true;
  plot.title = scores.truth.name + ": errors over time";
  plot.subtitle = subtitle_of(scores, "estimates aligned by their start alone");
  plot.panels = {
      panel_of(scores, "Distance from the truth, from 1 mm", "error [m]", kLeastMetres, distance),
      panel_of(scores, "Height error, from 1 mm", "error [m]", kLeastMetres, height)};
  if (scores.scoring.truth != TruthContent::kPosition) {
    plot.panels.push_back(panel_of(scores, "Heading error, from 0.01 degrees", "error [deg]",
                                   kLeastDegrees, heading_error_deg));
  }
  const Time start = scores.truth.trajectory.front().stamp;
  for (const WaypointTime& each : points_of(scores)) {
    plot.events.emplace_back(to_seconds(each.stamp - start), each.point);
  }
  return write_time_plot(file, plot);
}

}  // namespace

Result<void> draw_trajectory_pictures(const TrajectoryScores& scores,
                                      const std::filesystem::path& folder,
                                      const DrawObserver& observer) {
  announce(observer, folder / "trajectories.png");
  auto drawn = draw_trajectories(scores, folder / "trajectories.png");
  if (!drawn) return drawn;
  announce(observer, folder / "errors.png");
  return draw_errors(scores, folder / "errors.png");
}

}  // namespace aims
