// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/trajectory.hpp"
#include "render/plots/map_picture.hpp"

namespace aims {

/// Maps that several systems made of one run, to be seen side by side.
struct MapGrid {
  std::string title;
  std::string subtitle;
  std::vector<MapPicture> maps;  ///< all in the frame of the truth; `title` names each
  Trajectory truth;              ///< the picture shows what lies around it
  int width = 1800;              ///< [px]
};

/// Writes the maps from above, then from the side, all at one scale, over one part of the world and
/// with the colours of one range of heights, that around the truth. Error without maps or truth,
/// and when the file (.png) cannot be written.
Result<void> write_map_grid(const std::filesystem::path& path, const MapGrid& grid);

}  // namespace aims
