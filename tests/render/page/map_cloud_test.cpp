// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/map_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/render/page/decoded_page.hpp"

namespace aims {
namespace {

using Eigen::Vector3f;

constexpr std::uint64_t kSeed = 11;

std::vector<Vector3f> random_cloud(int count) {
  RandomStream stream(kSeed, "cloud");
  std::vector<Vector3f> points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(static_cast<float>(stream.uniform(-40.0, 40.0)),
                        static_cast<float>(stream.uniform(-1.0, 1.0)),
                        static_cast<float>(stream.uniform(0.0, 0.6)));
  }
  return points;
}

TEST(ThinnedCloud, KeepsASmallCloudAsItIs) {
  const auto points = random_cloud(100);
  EXPECT_EQ(thinned_cloud(points, 100), points);
}

TEST(ThinnedCloud, LeavesNoPartOfALargeOneEmpty) {
  const auto points = random_cloud(50000);
  const auto kept = thinned_cloud(points, 2000);
  EXPECT_LE(kept.size(), 2000U);
  EXPECT_GT(kept.size(), 300U);
  float farthest = 0.0F;
  for (const Vector3f& point : points) {
    float nearest = 1e9F;
    for (const Vector3f& other : kept) nearest = std::min(nearest, (point - other).norm());
    farthest = std::max(farthest, nearest);
  }
  EXPECT_LT(farthest, 1.5F) << "seed " << kSeed;
}

TEST(MapJson, PlacesAreExactToHalfAStepAndErrorsAreThoseOfTheSurface) {
  const auto points = random_cloud(1000);
  const Pose T_world_odom = {yaw_rotation(0.5), {3.0, -2.0, 0.1}};
  const SurfaceDistance surface{Scene{}};  // a flat floor: the distance is the height
  PageData page;
  page.json["map"] = map_json(points, T_world_odom, &surface, page);
  const auto back = testing::decoded(payload_text(page));
  const auto& map = back.json["map"];
  const auto places = back.array<std::uint16_t>(map["p"]);
  const auto errors = back.array<std::uint8_t>(map["error"]);
  ASSERT_EQ(errors.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d expected = T_world_odom * points[i].cast<double>();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double min = map["min"][axis];
      const double size = map["max"][axis].get<double>() - min;
      EXPECT_NEAR(min + size * places[3 * i + axis] / 65535.0, expected[static_cast<int>(axis)],
                  0.51 * size / 65535.0 + 1e-5);
    }
    const bool over_floor = expected.head<2>().cwiseAbs().maxCoeff() < 10.0;
    if (over_floor) {
      EXPECT_NEAR(errors[i] / 255.0 * 0.5, std::min(expected.z(), 0.5), 1.1e-3);
    }
  }
}

TEST(MapJson, TakesOnePointAndNone) {
  PageData page;
  EXPECT_TRUE(map_json({}, {}, nullptr, page).is_null());
  const std::vector<Vector3f> one = {{1.0F, 2.0F, 3.0F}};
  page.json["map"] = map_json(one, {}, nullptr, page);
  const auto back = testing::decoded(payload_text(page));
  EXPECT_EQ(back.array<std::uint16_t>(back.json["map"]["p"]), (std::vector<std::uint16_t>(3, 0)));
  EXPECT_TRUE(back.json["map"]["error"].is_null());
}

}  // namespace
}  // namespace aims
