// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/view_overlay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/plots/scene_plan.hpp"
#include "render/scene/scene_edges.hpp"
#include "render/scene/scene_view.hpp"

namespace aims {
namespace {

/// A dark cube of 0.4 m at the origin of the picture.
constexpr const char* kCube = R"(<mujoco><worldbody>
  <body pos="0 0 0"><freejoint/>
    <geom type="box" size="0.2 0.2 0.2" rgba="0.1 0.1 0.1 1"/></body>
</worldbody></mujoco>)";
const std::vector<double> kUpright = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
const Camera kCamera{{0.0, 0.0, 0.0}, 2.0, 0.0, 0.0};  // looks along +x from x = -2
constexpr std::array<std::uint8_t, 4> kRed = {255, 0, 0, 255};

int red_pixels(const std::vector<ViewPoint>& points, const ViewOverlay& look = {}) {
  auto view = SceneView::create(
      kCube, {}, {.width = 320, .height = 240, .samples = 0, .shadows = false, .sky = Color{}});
  EXPECT_TRUE(view);
  ViewOverlay overlay = look;
  overlay.points = points;
  const auto picture = view->draw(kUpright, kCamera, overlay);
  EXPECT_TRUE(picture);
  int count = 0;
  for (std::size_t i = 0; i < picture->rgb.size(); i += 3) {
    count += picture->rgb[i] > 100 && picture->rgb[i + 1] < 60 ? 1 : 0;
  }
  return count;
}

ViewOverlay large() {
  ViewOverlay overlay;
  overlay.point_diameter = 0.1F;
  return overlay;
}

TEST(ViewOverlay, ASolidHidesTheDotsBehindIt) {
  EXPECT_GT(red_pixels({{{-0.5F, 0.0F, 0.0F}, kRed}}, large()), 20);
  EXPECT_EQ(red_pixels({{{0.5F, 0.0F, 0.0F}, kRed}}, large()), 0);
  EXPECT_GT(red_pixels({{{0.5F, 0.6F, 0.0F}, kRed}}, large()), 20) << "beside it";
}

TEST(ViewOverlay, DotsAreAsLargeAsTheirDistanceSays) {
  const double focal_length = 120.0 / std::tan(25.0 * std::numbers::pi / 180.0);
  for (const float x : {-1.0F, -0.4F}) {
    const double diameter = 0.1 * focal_length / (2.0 + x);
    const int pixels = red_pixels({{{x, 0.0F, 0.0F}, kRed}}, large());
    // A disc, or the square around it.
    EXPECT_GT(pixels, 0.7 * 0.785 * diameter * diameter) << x;
    EXPECT_LT(pixels, 1.4 * diameter * diameter) << x;
  }
}

TEST(ViewOverlay, DotsFarAwayAreStillSeen) {
  ViewOverlay tiny;
  tiny.point_diameter = 0.001F;
  tiny.least_diameter = 2.0F;
  EXPECT_GE(red_pixels({{{40.0F, 10.0F, 0.0F}, kRed}}, tiny), 1);
}

TEST(ViewOverlay, HazeSwallowsWhatIsFar) {
  ViewOverlay hazy = large();
  hazy.haze_from = 0.5F;
  hazy.haze_to = 1.0F;
  EXPECT_EQ(red_pixels({{{-0.5F, 0.0F, 0.0F}, kRed}}, hazy), 0);
}

TEST(ViewOverlay, LinesLieInTheScene) {
  ViewOverlay lines;
  lines.lines.push_back({{{-0.5F, -5.0F, 0.0F}, {-0.5F, 5.0F, 0.0F}}, kRed, 3.0F});
  const int before = red_pixels({}, lines);
  EXPECT_NEAR(before, 3 * 320, 330);
  lines.lines.front().points = {{0.5F, -5.0F, 0.0F}, {0.5F, 5.0F, 0.0F}};
  const int behind = red_pixels({}, lines);
  EXPECT_LT(behind, before - 50) << "the cube hides the middle";
  EXPECT_GT(behind, 300);
}

TEST(ViewOverlay, TheSkyHasTheColorAskedFor) {
  auto view = SceneView::create(
      R"(<mujoco><asset><texture type="skybox" builtin="gradient" rgb1="1 1 1" rgb2="0 1 0"
           width="16" height="16"/></asset><worldbody/></mujoco>)",
      {},
      {.width = 160, .height = 120, .samples = 0, .shadows = false, .sky = Color{0.2, 0.4, 0.6}});
  ASSERT_TRUE(view) << view.error().message;
  const auto picture = view->draw({}, kCamera);
  ASSERT_TRUE(picture);
  EXPECT_NEAR(picture->pixel(80, 30)[0], 51, 2);
  EXPECT_NEAR(picture->pixel(10, 100)[2], 153, 2);
}

TEST(RoofCut, KeepsWhatIsLowOverTheLocalFloor) {
  // A floor that rises by 3 m, and a roof 2.6 m over it.
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20; ++i) {
    const float x = static_cast<float>(i);
    points.push_back({x, 0.5F, 0.15F * x});
    points.push_back({x, 0.5F, 0.15F * x + 2.6F});
  }
  const std::vector<bool> under = under_roof(points, 2.0);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(under[i], i % 2 == 0) << i;
}

TEST(SceneEdges, OfABoxAreTwelveAndOfARoofNone) {
  Scene scene;
  Solid box;
  box.half_extents = {1.0, 2.0, 3.0};
  box.T_world_solid.translation = {10.0, 0.0, 3.0};
  scene.solids = {box, box};
  scene.solids[1].roof = true;
  double length = 0.0;
  for (const auto& line : scene_edges(scene)) {
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    for (const Eigen::Vector3f& point : line) {
      EXPECT_FLOAT_EQ(std::abs(point.x() - 10.0F), 1.0F);
      EXPECT_FLOAT_EQ(std::abs(point.z() - 3.0F), 3.0F);
    }
  }
  EXPECT_NEAR(length, 4.0 * (2.0 + 4.0 + 6.0), 1e-3);
}

}  // namespace
}  // namespace aims
