// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/map_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/plots/palette.hpp"
#include "tests/render/plots/picture_file.hpp"

namespace aims {
namespace {

using test::PictureFolder;
using test::read_png;

/// A walk of 60 m along x.
Trajectory walk() {
  Trajectory truth;
  for (int i = 0; i <= 60; ++i) truth.push_back({i * kSecond, {{}, {1.0 * i, 0.0, 0.0}}});
  return truth;
}

/// A floor below the walk.
MapPicture floor_map(const std::string& title, float z) {
  MapPicture map;
  map.title = title;
  for (int i = 0; i < 20'000; ++i) {
    map.points.emplace_back(0.3F * static_cast<float>(i % 200),
                            -1.0F + 0.02F * static_cast<float>(i / 200), z);
  }
  map.trajectory = walk();
  return map;
}

/// Pixels of that fraction of the scale of colours.
int colour_pixels(const Image& image, double fraction) {
  const Color color = height_color(fraction);
  const auto channel = [](double value) { return static_cast<int>(std::lround(255.0 * value)); };
  return test::count_pixels(image, {channel(color.red), channel(color.green), channel(color.blue)},
                            4);
}

TEST(MapGrid, ShowsEachMapWithTheColoursOfOneRangeOfHeights) {
  const PictureFolder folder;
  MapGrid grid{"maps", "seed 1", {floor_map("low", 0.0F)}, walk()};
  ASSERT_TRUE(write_map_grid(folder / "one.png", grid));
  const Image one = read_png(folder / "one.png");
  grid.maps.push_back(floor_map("high", 1.5F));
  ASSERT_TRUE(write_map_grid(folder / "two.png", grid));
  const Image two = read_png(folder / "two.png");
  EXPECT_GT(two.height, one.height) << "a row more";
  // Heights from -1 to 2.5 m: 0 m has the colour at 2/7, 1.5 m that at 5/7.
  EXPECT_GT(colour_pixels(one, 2.0 / 7.0), 1000);
  EXPECT_GT(colour_pixels(two, 2.0 / 7.0), 1000);
  EXPECT_GT(colour_pixels(two, 5.0 / 7.0), colour_pixels(one, 5.0 / 7.0) + 1000);
}

TEST(MapGrid, ALostMapChangesNeitherScaleNorSize) {
  const PictureFolder folder;
  MapGrid grid{"maps", "", {floor_map("a", 0.0F), floor_map("b", 0.0F)}, walk()};
  ASSERT_TRUE(write_map_grid(folder / "near.png", grid));
  for (Eigen::Vector3f& point : grid.maps[1].points) point.x() += 4000.0F;
  ASSERT_TRUE(write_map_grid(folder / "lost.png", grid));
  EXPECT_EQ(read_png(folder / "near.png").width, read_png(folder / "lost.png").width);
  EXPECT_EQ(read_png(folder / "near.png").height, read_png(folder / "lost.png").height);
}

TEST(MapGrid, NothingToShowIsAnError) {
  const PictureFolder folder;
  EXPECT_FALSE(write_map_grid(folder / "none.png", {"maps", "", {}, walk()}));
  EXPECT_FALSE(write_map_grid(folder / "none.png", {"maps", "", {floor_map("a", 0.0F)}, {}}));
}

}  // namespace
}  // namespace aims
