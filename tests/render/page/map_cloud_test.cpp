// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/map_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

/// Nearest of the points, by its index.
std::size_t nearest(const std::vector<Vector3f>& points, const Vector3f& to) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if ((points[i] - to).squaredNorm() < (points[best] - to).squaredNorm()) best = i;
  }
  return best;
}

TEST(MapJson, PlacesAreExactToHalfAStepAndErrorsAreThoseOfTheSurface) {
  const auto points = random_cloud(1000);
  const Pose T_world_odom = {yaw_rotation(0.5), {3.0, -2.0, 0.1}};
  std::vector<Vector3f> expected;
  for (const Vector3f& point : points) {
    expected.push_back((T_world_odom * point.cast<double>()).cast<float>());
  }
  const SurfaceDistance surface{Scene{}};  // a flat floor: the distance is the height
  PageData page;
  page.json["map"] = map_json(points, T_world_odom, &surface, kMostMapPoints, false, page);
  const auto back = testing::decoded(payload_text(page));
  const auto& map = back.json["map"];
  const auto places = back.f32(map["p"]);
  const auto errors = back.array<std::uint8_t>(map["error"]);
  ASSERT_EQ(errors.size(), points.size());
  EXPECT_EQ(map["below"], points.size()) << "without a roof nothing is cut";
  std::vector<bool> found(points.size(), false);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f place(places[3 * i], places[3 * i + 1], places[3 * i + 2]);
    const std::size_t k = nearest(expected, place);
    found[k] = true;
    EXPECT_LT((place - expected[k]).cwiseAbs().maxCoeff(), 0.51 * kMapStep + 1e-5);
    if (expected[k].head<2>().cwiseAbs().maxCoeff() < 10.0F) {
      EXPECT_NEAR(errors[i] / 255.0 * 0.5, std::min(expected[k].z(), 0.5F), 1.1e-3);
    }
  }
  EXPECT_EQ(std::count(found.begin(), found.end(), false), 0) << "seed " << kSeed;
}

TEST(MapJson, PutsWhatIsBelowTheCeilingFirst) {
  std::vector<Vector3f> points;
  for (int i = 0; i < 300; ++i) {
    const float x = 0.01F * static_cast<float>(i);
    points.emplace_back(x, 0.0F, i % 3 == 0 ? 2.6F : 0.5F * static_cast<float>(i % 3 - 1));
  }
  PageData page;
  page.json["map"] = map_json(points, {}, nullptr, kMostMapPoints, true, page);
  const auto back = testing::decoded(payload_text(page));
  const auto places = back.f32(back.json["map"]["p"]);
  const std::size_t below = back.json["map"]["below"];
  EXPECT_EQ(below, 200U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(places[3 * i + 2] < 2.0F, i < below) << i;
  }
}

TEST(MapJson, TakesOnePointAndNone) {
  PageData page;
  EXPECT_TRUE(map_json({}, {}, nullptr, kMostMapPoints, true, page).is_null());
  const std::vector<Vector3f> one = {{1.0F, 2.0F, 3.0F}};
  page.json["map"] = map_json(one, {}, nullptr, kMostMapPoints, true, page);
  const auto back = testing::decoded(payload_text(page));
  EXPECT_EQ(back.f32(back.json["map"]["p"]), (std::vector<float>{1.0F, 2.0F, 3.0F}));
  EXPECT_TRUE(back.json["map"]["error"].is_null());
}

TEST(MapJson, OfManySystemsSharesTheBudgetOfThePage) {
  EXPECT_EQ(most_points(1), kMostMapPoints);
  EXPECT_EQ(most_points(0), kMostMapPoints);
  EXPECT_LE(13 * most_points(13), kMostPagePoints);
}

}  // namespace
}  // namespace aims
