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

std::size_t lines_of_floor() { return scene_geometry(Scene{}).open.edges.size(); }

TEST(SceneGeometry, OfABoxHasItsTwelveEdgesAndTwelveTriangles) {
  Scene scene;
  const SceneGeometry floor = scene_geometry(scene);
  scene.solids.push_back(box_at(0.0));
  const SceneGeometry geometry = scene_geometry(scene);
  EXPECT_EQ(geometry.open.edges.size() - floor.open.edges.size(), 2U * 12U);
  EXPECT_EQ(geometry.open.triangles.size() - floor.open.triangles.size(), 3U * 12U);
}

TEST(SceneGeometry, CornersOfABoxAreThoseOfItsSurface) {
  Scene scene;
  scene.solids.push_back(box_at(2.0));
  const TriangleMesh mesh = triangulate(scene.solids[0]);
  const SceneGeometry geometry = scene_geometry(scene);
  for (std::size_t i = lines_of_floor(); i < geometry.open.edges.size(); ++i) {
    float nearest = 1e9F;
    for (const Vector3f& vertex : mesh.vertices) {
      nearest = std::min(nearest, (vertex - geometry.open.edges[i]).norm());
    }
    EXPECT_LT(nearest, 1e-5F) << i;
  }
}

TEST(SceneGeometry, KeepsRoofsApartAndShowsNothingInvisible) {
  Scene scene;
  scene.solids = {box_at(0.0), box_at(3.0)};
  scene.solids[0].roof = true;
  scene.solids[1].visible = false;
  const SceneGeometry floor = scene_geometry(Scene{});
  const SceneGeometry geometry = scene_geometry(scene);
  EXPECT_EQ(geometry.open.edges.size(), floor.open.edges.size());
  EXPECT_EQ(geometry.open.triangles.size(), floor.open.triangles.size());
  EXPECT_EQ(geometry.roofs.edges.size(), 2U * 12U);
  EXPECT_EQ(geometry.roofs.triangles.size(), 3U * 12U);
}

TEST(SceneGeometry, SaysHowPeopleWalk) {
  Scene scene;
  scene.people = {{.from = {1.0, 2.0},
                   .to = {5.0, 2.0},
                   .speed = 1.5,
                   .start = 3.0,
                   .radius = 0.2,
                   .height = 1.8,
                   .material = {}}};
  PageData page;
  const auto json = scene_json(scene, page);
  ASSERT_EQ(json["people"].size(), 1U);
  EXPECT_EQ(json["people"][0]["from"], (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(json["people"][0]["to"], (std::vector<double>{5.0, 2.0}));
  EXPECT_EQ(json["people"][0]["start"], 3.0);
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
    EXPECT_LT(geometry.open.triangles.size(), 3U * 30000U);
    float largest = 0.0F;
    for (const Vector3f& corner : geometry.open.triangles) {
      largest = std::max(largest, distance(corner, 1.0F));
    }
    // A coarser floor and flatter cylinders: no more than the bumps and the arc's height.
    EXPECT_LT(largest, 0.05F) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace aims
