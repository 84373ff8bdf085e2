// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/trajectory.hpp"

namespace aims {

enum class MapView {
  kAbove,  ///< along -z; what is higher than the section above the local floor is left out
  kSide,   ///< along +y
};

/// Heights that the lowest and the highest colour stand for [m].
struct HeightRange {
  double min = 0.0;
  double max = 1.0;
};

/// A map and the trajectory that made it, both in one frame, and how to show them.
struct MapPicture {
  std::string title;
  std::vector<Eigen::Vector3f> points;  ///< [m]; points that are not finite are left out
  Trajectory trajectory;
  std::optional<HeightRange> heights;  ///< default: `map_heights(points)`
  double section = 2.0;  ///< kAbove: height over the local floor of the cut that opens the roof [m]
  int width = 1800;      ///< [px]
  std::string frame = "odometry frame";  ///< of the points, for the subtitle
};

/// 1st and 99th percentile of the points' heights, at least 0.5 m apart; finite points count.
HeightRange map_heights(const std::vector<Eigen::Vector3f>& points);

/// Writes the points coloured by height, at equal scale in both directions, with axes in metres,
/// a labelled colour scale and the trajectory as a thin line. A map much longer than wide is cut
/// into strips below one another. In .svg and .pdf the points that are seen, one per small cell,
/// are vector squares, or pixels of twice the density when there are more than 40,000. A map
/// without points gives axes and a note. Error when the file
/// (.png, .svg, .pdf) cannot be written.
Result<void> write_map_picture(const std::filesystem::path& path, MapView view,
                               const MapPicture& map);

}  // namespace aims
