// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// Name of the floor's geom (a plane when flat, else the height field) in every product.
inline constexpr std::string_view kFloorGeomName = "floor";
/// Prefix of the names of all other static geoms: "solid_<index in Scene::solids>".
inline constexpr std::string_view kSolidGeomPrefix = "solid_";

enum class MjcfPurpose {
  kPhysics,  ///< colliding solids only, no appearance
  kRender,   ///< visible solids, lights, textures; nothing collides
};

struct MjcfOptions {
  double floor_friction = 0.8;  ///< sliding friction of floor and solids [-]
  bool roof = false;            ///< kRender: keep the solids marked as roof
  int image_width = 1280;       ///< kRender: largest off-screen picture [px]
  int image_height = 720;       ///< kRender: largest off-screen picture [px]
};

/// The robot's MJCF document with the scene added: floor and solids as geoms of the world body,
/// with contype = conaffinity = 1 in the physics product. An empty `robot_mjcf` gives the scene
/// alone. Error when `robot_mjcf` is not an MJCF document.
/// A floor with heights becomes a height field whose data is not in the text: copy
/// `height_field_data(scene.floor)` to `model->hfield_data` after loading (before mjr_makeContext).
Result<std::string> scene_mjcf(const Scene& scene, std::string_view robot_mjcf, MjcfPurpose purpose,
                               const MjcfOptions& options = {});

/// Elevations in [0, 1] as MuJoCo keeps them, row by row; empty for a flat floor.
std::vector<float> height_field_data(const Floor& floor);

}  // namespace aims
