// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/robot_pictures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "render/scene/offscreen_context.hpp"
#include "sim/environment/scene_config.hpp"
#include "sim/environment/scene_mjcf.hpp"
#include "tests/render/plots/picture_file.hpp"

namespace aims {
namespace {

using test::PictureFolder;
using test::read_png;

constexpr const char* kCube = R"(<mujoco><worldbody>
  <body pos="0 0 0"><freejoint/>
    <geom type="box" size="0.2 0.2 0.2" rgba="1 0 0 1"/></body>
</worldbody></mujoco>)";

const std::vector<double> kUpright = {0.0, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0};

ViewConfig small() { return {.width = 320, .height = 180, .samples = 0, .shadows = false}; }

bool is_red(const std::array<std::uint8_t, 3>& pixel) {
  return pixel[0] > 60 && pixel[0] > 3 * pixel[1] && pixel[0] > 3 * pixel[2];
}

int red_pixels(const Image& image) {
  int count = 0;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) count += is_red(image.pixel(column, row));
  }
  return count;
}

TEST(OffscreenContext, CanBeMadeAgainAndAgain) {
  for (int i = 0; i < 3; ++i) {
    const auto context = OffscreenContext::create();
    ASSERT_TRUE(context) << context.error().message;
  }
}

TEST(SceneView, DrawsASolidAsLargeAsItsDistanceSays) {
  auto view = SceneView::create(kCube, {}, small());
  ASSERT_TRUE(view) << view.error().message;
  const Camera camera{{0.0, 0.0, 0.3}, 2.0, 0.0, 0.0};
  const auto picture = view->draw(kUpright, camera);
  ASSERT_TRUE(picture) << picture.error().message;
  // The face 1.8 m ahead is 0.4 m high; the picture, 50 degrees.
  const double side = 180.0 * 0.4 / (2.0 * 1.8 * std::tan(25.0 * std::numbers::pi / 180.0));
  EXPECT_NEAR(red_pixels(*picture), side * side, 0.06 * side * side);
  EXPECT_TRUE(is_red(picture->pixel(160, 90)));
  EXPECT_FALSE(is_red(picture->pixel(10, 10)));
}

TEST(SceneView, DrawsUpAsUp) {
  auto view = SceneView::create(kCube, {}, small());
  ASSERT_TRUE(view);
  auto raised = kUpright;
  raised[2] = 0.8;
  const auto picture = view->draw(raised, {{0.0, 0.0, 0.3}, 2.0, 0.0, 0.0});
  ASSERT_TRUE(picture);
  EXPECT_TRUE(is_red(picture->pixel(160, 40)));
  EXPECT_FALSE(is_red(picture->pixel(160, 140)));
}

TEST(SceneView, RefusesWhatItCannotDraw) {
  EXPECT_FALSE(SceneView::create("<mujoco><nonsense/></mujoco>", {}, small()));
  EXPECT_FALSE(SceneView::create("no document", {}, small()));
  auto view = SceneView::create(kCube, {}, small());
  ASSERT_TRUE(view);
  EXPECT_FALSE(view->draw({0.0, 0.0}, {}));
  auto broken = kUpright;
  broken[1] = std::nan("");
  EXPECT_FALSE(view->draw(broken, {}));
}

/// Along +x, a turn on the spot, and back.
std::vector<RobotSnapshot> there_and_back() {
  std::vector<RobotSnapshot> snapshots;
  const auto add = [&](double x, double yaw) {
    snapshots.push_back({static_cast<Time>(snapshots.size()) * 100 * kMillisecond,
                         {x, 0.0, 0.3, std::cos(yaw / 2.0), 0.0, 0.0, std::sin(yaw / 2.0)}});
  };
  for (int i = 0; i <= 100; ++i) add(0.2 * i, 0.0);
  for (int i = 1; i <= 20; ++i) add(20.0, std::numbers::pi * i / 20.0);
  for (int i = 99; i >= 0; --i) add(0.2 * i, std::numbers::pi);
  return snapshots;
}

TEST(RobotPictures, ShowTheStartTheMiddleAndTheTurn) {
  const auto notable = notable_snapshots(there_and_back());
  ASSERT_EQ(notable.size(), 3U);
  EXPECT_NEAR(static_cast<double>(notable[0]), 8.0, 2.0);
  EXPECT_NEAR(static_cast<double>(notable[1]), 50.0, 2.0);
  EXPECT_GT(notable[2], 105U);
  EXPECT_LT(notable[2], 120U);
  EXPECT_TRUE(notable_snapshots({}).empty());
  EXPECT_EQ(notable_snapshots({{0, kUpright}}).size(), 1U);
}

TEST(RobotPictures, CameraIsInsideTheCorridorAndNearTheAxis) {
  const Scene scene = build_scene({}, 1);
  for (const double y : {-0.6, 0.0, 0.6}) {
    for (const double heading : {0.0, std::numbers::pi}) {
      const Camera camera = robot_camera(scene, {40.0, y, 0.3, 1.0, 0.0, 0.0, 0.0}, heading);
      EXPECT_FALSE(is_inside_solid(scene, camera.position(), 0.05));
      const double aside = std::remainder(camera.azimuth_deg, 180.0);
      EXPECT_LE(std::abs(aside), 25.0 + 1e-9);
    }
  }
}

TEST(RobotPictures, TheRobotIsSeenInEach) {
  const PictureFolder folder;
  const Scene scene = build_scene({}, 1);
  const ViewConfig config{.width = 320, .height = 180, .samples = 0, .shadows = true};
  const auto files =
      write_robot_pictures(folder.path(), "test", scene, kCube, there_and_back(), config);
  ASSERT_TRUE(files) << files.error().message;
  ASSERT_EQ(files->size(), 3U);
  for (const auto& file : *files) EXPECT_GT(red_pixels(read_png(file)), 400) << file;
  EXPECT_EQ(folder.files(), 3U);
}

TEST(RobotPictures, SayWhyThereAreNone) {
  const PictureFolder folder;
  const Scene scene;
  EXPECT_FALSE(write_robot_pictures(folder.path(), "test", scene, kCube, {}, small()));
  EXPECT_FALSE(
      write_robot_pictures(folder / "missing", "test", scene, kCube, {{0, kUpright}}, small()));
}

}  // namespace
}  // namespace aims
