// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/scene_geometry.hpp"

#include <gtest/gtest.h>

#include <array>

#include "render/page/surface_distance.hpp"
#include "sim/environment/scene_config.hpp"
#include "sim/environment/triangles.hpp"

namespace aims {
namespace {

using Eigen::Vector3f;

Solid box_at(double x) {
  Solid box;
  box.half_extents = {0.5, 1.0, 1.5};
  box.T_world_solid = {yaw_rotation(0.3), {x, 0.0, 1.5}};
  return box;
}

std::size_t lines_of_floor() { return scene_geometry(Scene{}).edges.size(); }

TEST(SceneGeometry, OfABoxHasItsTwelveEdgesAndTwelveTriangles) {
  Scene scene;
  const SceneGeometry floor = scene_geometry(scene);
  scene.solids.push_back(box_at(0.0));
  const SceneGeometry geometry = scene_geometry(scene);
  EXPECT_EQ(geometry.edges.size() - floor.edges.size(), 2U * 12U);
  EXPECT_EQ(geometry.triangles.size() - floor.triangles.size(), 3U * 12U);
}

TEST(SceneGeometry, CornersOfABoxAreThoseOfItsSurface) {
  Scene scene;
  scene.solids.push_back(box_at(2.0));
  const TriangleMesh mesh = triangulate(scene.solids[0]);
  const SceneGeometry geometry = scene_geometry(scene);
  for (std::size_t i = lines_of_floor(); i < geometry.edges.size(); ++i) {
    float nearest = 1e9F;
    for (const Vector3f& vertex : mesh.vertices) {
      nearest = std::min(nearest, (vertex - geometry.edges[i]).norm());
    }
    EXPECT_LT(nearest, 1e-5F) << i;
  }
}

TEST(SceneGeometry, ShowsRoofsByTheirEdgesAloneAndNothingInvisible) {
  Scene scene;
  scene.solids = {box_at(0.0), box_at(3.0)};
  scene.solids[0].roof = true;
  scene.solids[1].visible = false;
  const SceneGeometry floor = scene_geometry(Scene{});
  const SceneGeometry geometry = scene_geometry(scene);
  EXPECT_EQ(geometry.edges.size() - floor.edges.size(), 2U * 12U);
  EXPECT_EQ(geometry.triangles.size(), floor.triangles.size());
}

TEST(SceneGeometry, OfEveryKindLiesOnTheTrueSurfaceAndStaysSmall) {
  for (const SceneKind kind :
       {SceneKind::kCorridor, SceneKind::kGarage, SceneKind::kJunction, SceneKind::kTunnel}) {
    SceneConfig config;
    config.kind = kind;
    config.bumps.height = 0.03;
    const Scene scene = build_scene(config, 1);
    const SurfaceDistance distance(scene);
    const SceneGeometry geometry = scene_geometry(scene);
    EXPECT_LT(geometry.triangles.size(), 3U * 30000U);
    float largest = 0.0F;
    for (const Vector3f& corner : geometry.triangles) {
      largest = std::max(largest, distance(corner, 1.0F));
    }
    // A coarser floor and flatter cylinders: no more than the bumps and the arc's height.
    EXPECT_LT(largest, 0.05F) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace aims
