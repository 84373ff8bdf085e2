// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/vector_pictures.hpp"

#include <fmt/format.h>

#include "render/plots/map_picture.hpp"

namespace aims {
namespace {

constexpr const char* kStartAligned = "estimates aligned by their start alone";

TrajectoryPlot trajectories_of(const FilmedSequence& sequence) {
  TrajectoryPlot plot;
  plot.title = sequence.scenario + ": estimated trajectories";
  plot.subtitle = fmt::format("seed {}  ·  {}", sequence.seed, kStartAligned);
  plot.scene = sequence.scene;
  plot.truth = sequence.truth;
  plot.estimates = sequence.estimates;
  plot.waypoint_times = sequence.waypoint_times;
  return plot;
}

MapPicture map_of(const FilmedSequence& sequence) {
  MapPicture map;
  map.title = fmt::format("{}: map of {}", sequence.scenario, sequence.estimates.front().name);
  map.frame = "aligned with the truth at the start";
  for (const GrownPoint& point : sequence.map) map.points.push_back(point.position);
  map.trajectory = sequence.estimates.front().trajectory;
  return map;
}

}  // namespace

Result<std::vector<std::string>> write_vector_pictures(const FilmedSequence& sequence,
                                                       const std::vector<std::string>& endings,
                                                       const std::filesystem::path& folder) {
  std::vector<std::string> files;
  const TrajectoryPlot trajectories = trajectories_of(sequence);
  const bool mapped = !sequence.map.empty() && !sequence.estimates.empty();
  const MapPicture map = mapped ? map_of(sequence) : MapPicture{};
  const std::string name = mapped ? sequence.estimates.front().name : std::string();
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
