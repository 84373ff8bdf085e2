// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/surface_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::uint64_t kSeed = 5;

/// A box of 2 x 1 x 0.6 m, turned by 0.4 rad, hovering over a floor that lies far away.
Scene box_alone() {
  Scene scene;
  scene.floor.min_corner = {900.0, 900.0};
  scene.floor.max_corner = {910.0, 910.0};
  Solid box;
  box.half_extents = {1.0, 0.5, 0.3};
  box.T_world_solid = {yaw_rotation(0.4), {2.0, -1.0, 1.0}};
  scene.solids.push_back(box);
  return scene;
}

/// Closed form of the distance to the surface of a box, from inside too.
double distance_to_box(const Solid& box, const Vector3d& point) {
  const Vector3d p = (box.T_world_solid.inverse() * point).cwiseAbs() - box.half_extents;
  if ((p.array() <= 0.0).all()) return -p.maxCoeff();
  return p.cwiseMax(0.0).norm();
}

TEST(SurfaceDistance, IsThatOfTheClosedFormAroundAndInsideABox) {
  const Scene scene = box_alone();
  const SurfaceDistance distance(scene);
  RandomStream stream(kSeed, "test");
  for (int i = 0; i < 2000; ++i) {
    const Vector3d offset(stream.uniform(-2.0, 2.0), stream.uniform(-2.0, 2.0),
                          stream.uniform(-2.0, 2.0));
    const Vector3d point = scene.solids[0].T_world_solid.translation + offset;
    const double expected = distance_to_box(scene.solids[0], point);
    const float found = distance(point.cast<float>(), 1.0F);
    EXPECT_NEAR(found, std::min(expected, 1.0), 2e-6) << "seed " << kSeed << " point " << i;
  }
}

TEST(SurfaceDistance, OfAFlatFloorIsTheHeight) {
  const SurfaceDistance distance(Scene{});
  EXPECT_NEAR(distance({1.0F, 2.0F, 0.3F}, 0.5F), 0.3F, 1e-6F);
  EXPECT_NEAR(distance({1.0F, 2.0F, -0.2F}, 0.5F), 0.2F, 1e-6F);
  EXPECT_EQ(distance({1.0F, 2.0F, 3.0F}, 0.5F), 0.5F) << "nothing within the limit";
}

TEST(SurfaceDistance, IgnoresWhatTheLidarDoesNotSee) {
  Scene scene = box_alone();
  scene.solids[0].visible = false;
  const Vector3f beside = scene.solids[0].T_world_solid.translation.cast<float>();
  EXPECT_EQ(SurfaceDistance(scene)(beside, 0.5F), 0.5F);
}

TEST(SquaredDistance, OfATriangleIsTheLeastOverManyOfItsPoints) {
  RandomStream stream(kSeed, "triangle");
  const auto place = [&] {
    return Vector3f(static_cast<float>(stream.uniform(-1.0, 1.0)),
                    static_cast<float>(stream.uniform(-1.0, 1.0)),
                    static_cast<float>(stream.uniform(-1.0, 1.0)));
  };
  constexpr int kSteps = 200;
  for (int i = 0; i < 50; ++i) {
    const Vector3f a = place();
    const Vector3f b = place();
    const Vector3f c = place();
    const Vector3f p = 2.0F * place();
    float least = 1e9F;
    for (int u = 0; u <= kSteps; ++u) {
      for (int v = 0; u + v <= kSteps; ++v) {
        const Vector3f q =
            a + static_cast<float>(u) / kSteps * (b - a) + static_cast<float>(v) / kSteps * (c - a);
        least = std::min(least, (p - q).norm());
      }
    }
    const float found = std::sqrt(squared_distance(p, a, b, c));
    EXPECT_LE(found, least + 1e-5F) << "seed " << kSeed << " triangle " << i;
    EXPECT_NEAR(found, least, 0.01F) << "seed " << kSeed << " triangle " << i;
  }
}

TEST(SquaredDistance, TakesATriangleThatIsALineOrAPoint) {
  const Vector3f a(0.0F, 0.0F, 0.0F);
  const Vector3f b(1.0F, 0.0F, 0.0F);
  EXPECT_FLOAT_EQ(squared_distance({0.5F, 2.0F, 0.0F}, a, b, b), 4.0F);
  EXPECT_FLOAT_EQ(squared_distance({0.0F, 0.0F, 3.0F}, a, a, a), 9.0F);
}

}  // namespace
}  // namespace aims
