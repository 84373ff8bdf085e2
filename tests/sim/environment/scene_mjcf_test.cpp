// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/scene_mjcf.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "core/random.hpp"
#include "sim/environment/mujoco_model.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;

constexpr const char* kRobot = R"(<mujoco model="ball">
  <default><geom contype="2" conaffinity="4" condim="1" margin="0.5"/></default>
  <worldbody>
    <body name="trunk" pos="0 0 0.5">
      <freejoint/>
      <geom type="sphere" size="0.1" mass="1" contype="0" conaffinity="1" margin="0"/>
    </body>
  </worldbody>
</mujoco>)";

MujocoModel load(const Scene& scene, MjcfPurpose purpose, const MjcfOptions& options = {}) {
  const auto text = scene_mjcf(scene, kRobot, purpose, options);
  if (!text) throw std::runtime_error(text.error().message);
  auto model = load_mujoco_model(*text, height_field_data(scene.floor));
  if (!model) throw std::runtime_error(model.error().message);
  return std::move(*model);
}

SceneConfig furnished_corridor(double bump_height) {
  SceneConfig config;
  config.bumps.height = bump_height;
  config.corridor.doors.sides = WallSides::kAlternate;
  config.corridor.pillars.spacing = 10.0;
  config.corridor.clutter.density = 0.5;
  return config;
}

TEST(SceneMjcf, PhysicsHasFewGeomsAndTheNamedFloor) {
  for (const double bump_height : {0.0, 0.02}) {
    const Scene scene = build_scene(furnished_corridor(bump_height), 1);
    const MujocoModel model = load(scene, MjcfPurpose::kPhysics);
    EXPECT_LT(model->ngeom, 50);
    const int floor = mj_name2id(model.get(), mjOBJ_GEOM, std::string(kFloorGeomName).c_str());
    ASSERT_GE(floor, 0);
    EXPECT_EQ(model->geom_type[floor], bump_height > 0.0 ? mjGEOM_HFIELD : mjGEOM_PLANE);
    for (std::size_t i = 0; i < scene.solids.size(); ++i) {
      const std::string name = std::string(kSolidGeomPrefix) + std::to_string(i);
      EXPECT_EQ(mj_name2id(model.get(), mjOBJ_GEOM, name.c_str()) >= 0, scene.solids[i].collides);
    }
  }
}

TEST(SceneMjcf, RobotsDefaultsDoNotReachTheScene) {
  const MujocoModel model =
      load(build_scene({}, 1), MjcfPurpose::kPhysics, {.floor_friction = 0.6});
  for (int geom = 0; geom < model->ngeom; ++geom) {
    if (model->geom_bodyid[geom] != 0) continue;
    EXPECT_EQ(model->geom_contype[geom], 1);
    EXPECT_EQ(model->geom_conaffinity[geom], 1);
    EXPECT_EQ(model->geom_condim[geom], 3);
    EXPECT_EQ(model->geom_margin[geom], 0.0);
    EXPECT_EQ(model->geom_friction[3 * geom], 0.6);
  }
}

/// Height at which the robot's ball comes to rest on the floor under (x, y).
double resting_height(const mjModel* model, double x, double y) {
  const MujocoData data(mj_makeData(model));
  data->qpos[0] = x;
  data->qpos[1] = y;
  for (int step = 0; step < 300; ++step) {
    mj_step(model, data.get());
    for (const int axis : {0, 1}) data->qvel[axis] = 0.0;
    for (const int axis : {3, 4, 5}) data->qvel[axis] = 0.0;
  }
  return data->qpos[2] - 0.1;
}

TEST(SceneMjcf, BallsRestOnTheFloorThatRaysSee) {
  const Scene scene = build_scene(furnished_corridor(0.02), 1);
  const MujocoModel model = load(scene, MjcfPurpose::kPhysics);
  const RayCaster caster(scene);
  for (const double x : {0.0, 13.3, 50.1, 78.6}) {
    const double seen = 1.0 - caster.cast({x, 0.1, 1.0}, -Vector3d::UnitZ())->distance;
    EXPECT_NEAR(resting_height(model.get(), x, 0.1), seen, 0.002) << x;
  }
}

TEST(SceneMjcf, WallsStopTheRobotFlushWithWhatRaysSee) {
  const MujocoModel model = load(build_scene({}, 1), MjcfPurpose::kPhysics);
  const MujocoData data(mj_makeData(model.get()));
  data->qpos[0] = 1.0;  // in front of a door's recess, which physics leaves flat
  data->qpos[1] = -0.99;
  mj_forward(model.get(), data.get());
  EXPECT_EQ(data->ncon, 0);
  data->qpos[1] = -1.01;
  mj_forward(model.get(), data.get());
  ASSERT_EQ(data->ncon, 1);
  const mjContact& contact = data->contact[0];
  const int wall = model->geom_bodyid[contact.geom1] == 0 ? contact.geom1 : contact.geom2;
  const std::string name = mj_id2name(model.get(), mjOBJ_GEOM, wall);
  EXPECT_TRUE(name.starts_with(kSolidGeomPrefix)) << name;
}

/// Compares the ray caster with MuJoCo's own rays through the pictures' model.
void compare_rays(double bump_height) {
  const Scene scene = build_scene(furnished_corridor(bump_height), 1);
  const MujocoModel model = load(scene, MjcfPurpose::kRender, {.roof = true});
  const MujocoData data(mj_makeData(model.get()));
  mj_forward(model.get(), data.get());
  const RayCaster caster(scene);
  RandomStream random = rng(11, "rays");
  int disagreements = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d origin(random.uniform(0.0, 78.0), random.uniform(-0.6, 0.6),
                          random.uniform(0.1, 2.4));
    const Vector3d direction = random.normal3().normalized();
    int geom = -1;
    const double oracle =
        mj_ray(model.get(), data.get(), origin.data(), direction.data(), nullptr, 1, 1, &geom);
    const auto hit = caster.cast(origin, direction);
    ASSERT_TRUE(hit);
    // Cylinders differ by their tessellation, rays past an edge by rounding.
    const bool round = geom >= 0 && model->geom_type[geom] == mjGEOM_CYLINDER;
    if (std::abs(hit->distance - oracle) > (round ? 0.01 : 5e-4)) ++disagreements;
  }
  EXPECT_LE(disagreements, 2) << "seed 11";
}

TEST(SceneMjcf, PicturesShowWhatRaysSeeOnAFlatFloor) { compare_rays(0.0); }

TEST(SceneMjcf, PicturesShowWhatRaysSeeOnBumps) { compare_rays(0.02); }

TEST(SceneMjcf, RenderHasNoRoofUnlessAsked) {
  const Scene scene = build_scene({}, 1);
  const int without = load(scene, MjcfPurpose::kRender)->ngeom;
  const MujocoModel with = load(scene, MjcfPurpose::kRender, {.roof = true, .image_width = 1920});
  EXPECT_EQ(with->ngeom, without + 1);
  EXPECT_EQ(with->vis.global.offwidth, 1920);
  EXPECT_EQ(with->vis.global.offheight, 720);
  for (int geom = 0; geom < with->ngeom; ++geom) {
    EXPECT_TRUE(with->geom_bodyid[geom] != 0 || with->geom_contype[geom] == 0);
  }
}

TEST(SceneMjcf, RejectsWhatIsNoMjcf) {
  EXPECT_FALSE(scene_mjcf({}, "<mujoco>", MjcfPurpose::kPhysics));
  EXPECT_FALSE(scene_mjcf({}, "<robot/>", MjcfPurpose::kPhysics));
  EXPECT_TRUE(scene_mjcf({}, "", MjcfPurpose::kPhysics));
}

}  // namespace
}  // namespace aims
