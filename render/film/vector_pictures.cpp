// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/vector_pictures.hpp"

#include <fmt/format.h>

#include "render/plots/map_picture.hpp"

namespace aims {
namespace {

TrajectoryPlot trajectories_of(const FilmedWalk& walk) {
  TrajectoryPlot plot;
  plot.title = walk.scenario + ": estimated trajectories";
  plot.subtitle = fmt::format("seed {}", walk.seed);
  plot.scene = walk.scene;
  plot.truth = walk.truth;
  plot.estimates = walk.estimates;
  plot.waypoint_times = walk.waypoint_times;
  return plot;
}

MapPicture map_of(const FilmedWalk& walk) {
  MapPicture map;
  map.title = fmt::format("{}: map of {}", walk.scenario, walk.estimates.front().name);
  map.frame = "laid onto the truth at the start";
  for (const GrownPoint& point : walk.map) map.points.push_back(point.position);
  map.trajectory = walk.estimates.front().trajectory;
  return map;
}

}  // namespace

Result<std::vector<std::string>> write_vector_pictures(const FilmedWalk& walk,
                                                       const std::vector<std::string>& endings,
                                                       const std::filesystem::path& folder) {
  std::vector<std::string> files;
  const TrajectoryPlot trajectories = trajectories_of(walk);
  const bool mapped = !walk.map.empty() && !walk.estimates.empty();
  const MapPicture map = mapped ? map_of(walk) : MapPicture{};
  const std::string name = mapped ? walk.estimates.front().name : std::string();
  for (const std::string& ending : endings) {
    files.push_back("trajectories" + ending);
    auto written = write_trajectory_plot(folder / files.back(), trajectories);
    for (const auto& [view, suffix] :
         {std::pair{MapView::kAbove, "-map-top"}, {MapView::kSide, "-map-side"}}) {
      if (!mapped || !written) continue;
      files.push_back(name + suffix + ending);
      written = write_map_picture(folder / files.back(), view, map);
    }
    if (!written) return tl::unexpected(written.error());
  }
  return files;
}

}  // namespace aims
