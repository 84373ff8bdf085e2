// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/page/page_data.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// Surfaces as lines and triangles to look at, in the world [m].
struct SurfaceGeometry {
  std::vector<Eigen::Vector3f> edges;      ///< two per line: outlines of solids and of the floor
  std::vector<Eigen::Vector3f> triangles;  ///< three each
};

/// A scene to look at; the roofs are apart, so that one can look inside.
struct SceneGeometry {
  SurfaceGeometry open;
  SurfaceGeometry roofs;
};

/// Geometry of the visible solids and the floor; people are left out, cylinders have few sides, and
/// a floor of many cells is shown by fewer.
SceneGeometry scene_geometry(const Scene& scene);

/// `scene_geometry` with the floor's extent, the bounds of all of it, and how the people walk.
Json scene_json(const Scene& scene, PageData& page);

}  // namespace aims
