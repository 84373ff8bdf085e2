// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/map_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "render/plots/palette.hpp"
#include "render/plots/point_raster.hpp"
#include "tests/render/plots/picture_file.hpp"

namespace aims {
namespace {

using test::count_pixels;
using test::PictureFolder;
using test::read_png;

constexpr std::array<std::uint8_t, 3> kBlack = {0, 0, 0};

/// Relative luminance of sRGB, up to its gamma: enough to order greys.
double luminance(const std::array<std::uint8_t, 3>& rgb) {
  const auto linear = [](std::uint8_t value) { return std::pow(value / 255.0, 2.2); };
  return 0.2126 * linear(rgb[0]) + 0.7152 * linear(rgb[1]) + 0.0722 * linear(rgb[2]);
}

TEST(MapPicture, LongSubtitlesAreNotCut) {
  const PictureFolder folder;
  MapPicture map;
  map.title = "a map";
  map.width = 700;
  for (int i = 0; i < 2000; ++i) {
    map.points.emplace_back(0.02F * static_cast<float>(i), i % 2 == 0 ? 1.0F : -1.0F, 0.5F);
  }
  map.points.emplace_back(std::nanf(""), 0.0F, 0.0F);
  for (const MapView view : {MapView::kAbove, MapView::kSide}) {
    ASSERT_TRUE(write_map_picture(folder / "a.png", view, map));
    const Image image = read_png(folder / "a.png");
    EXPECT_EQ(test::ink_right_of(image, image.width - 10), 0);
  }
}

TEST(HeightColor, GrowsLighterWithHeight) {
  const auto table = height_table();
  for (std::size_t i = 8; i < table.size(); ++i) {
    EXPECT_GT(luminance(table[i]), luminance(table[i - 8])) << i;
  }
}

TEST(HeightColor, IsThatOfTheNearestEndOutsideTheScale) {
  EXPECT_EQ(height_color(-3.0).green, height_color(0.0).green);
  EXPECT_EQ(height_color(7.0).green, height_color(1.0).green);
  EXPECT_EQ(height_color(std::nan("")).green, height_color(0.0).green);
}

TEST(PointRaster, PutsPointsWhereTheyAre) {
  const Image image =
      raster_points({{2.5F, 1.5F, 0.0F, 1.0F}}, {0.0, 10.0, 0.0, 10.0}, 10, 10, 1, kBlack);
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) {
      const bool lit = image.pixel(column, row) != kBlack;
      EXPECT_EQ(lit, column == 2 && row == 8) << column << " " << row;
    }
  }
}

TEST(PointRaster, ShowsTheNearestPoint) {
  const RasterWindow window{0.0, 1.0, 0.0, 1.0};
  const RasterPoint low{0.5F, 0.5F, 1.0F, 0.0F};
  const RasterPoint high{0.5F, 0.5F, 2.0F, 1.0F};
  const auto expected = height_table()[255];
  EXPECT_EQ(raster_points({low, high}, window, 1, 1, 1, kBlack).pixel(0, 0), expected);
  EXPECT_EQ(raster_points({high, low}, window, 1, 1, 1, kBlack).pixel(0, 0), expected);
}

TEST(PointRaster, LeavesOutWhatIsOutsideTheWindow) {
  const Image image = raster_points({{-1.0F, 0.5F, 0.0F, 1.0F}, {0.5F, 9.0F, 0.0F, 1.0F}},
                                    {0.0, 1.0, 0.0, 1.0}, 4, 4, 3, kBlack);
  EXPECT_EQ(count_pixels(image, {0, 0, 0}, 0), 16);
}

std::vector<Eigen::Vector3f> slab(float z) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 400; ++i) {
    for (int j = 0; j < 40; ++j) points.emplace_back(0.05F * i, 0.05F * j, z);
  }
  return points;
}

TEST(MapPicture, ColoursPointsByTheirHeight) {
  const PictureFolder folder;
  const auto table = height_table();
  for (const auto& [height, index] : {std::pair{0.0F, 0U}, std::pair{1.0F, 128U}}) {
    MapPicture map;
    map.points = slab(height);
    map.heights = HeightRange{0.0, 2.0};
    ASSERT_TRUE(write_map_picture(folder / "a.png", MapView::kAbove, map));
    const std::array<int, 3> color = {table[index][0], table[index][1], table[index][2]};
    EXPECT_GT(count_pixels(read_png(folder / "a.png"), color, 4), 20000) << height;
  }
}

TEST(MapPicture, LooksBelowTheRoofFromAbove) {
  const PictureFolder folder;
  MapPicture map;
  map.points = slab(0.0F);
  const auto roof = slab(2.6F);
  map.points.insert(map.points.end(), roof.begin(), roof.end());
  map.heights = HeightRange{0.0, 2.6};
  ASSERT_TRUE(write_map_picture(folder / "a.png", MapView::kAbove, map));
  const auto floor = height_table()[0];
  EXPECT_GT(count_pixels(read_png(folder / "a.png"), {floor[0], floor[1], floor[2]}, 4), 20000);
}

TEST(MapPicture, SurvivesMapsThatAreNone) {
  const PictureFolder folder;
  const float nan = std::nanf("");
  const std::vector<std::vector<Eigen::Vector3f>> maps = {
      {}, {{1.0F, 2.0F, 3.0F}}, {{nan, 0.0F, 0.0F}, {0.0F, INFINITY, 0.0F}}};
  for (const auto& points : maps) {
    for (const MapView view : {MapView::kAbove, MapView::kSide}) {
      MapPicture map;
      map.points = points;
      map.trajectory.resize(1);
      map.trajectory[0].pose.translation.x() = nan;
      ASSERT_TRUE(write_map_picture(folder / "a.png", view, map));
      EXPECT_EQ(read_png(folder / "a.png").width, 1800);
    }
  }
}

TEST(MapPicture, KeepsItsSizeWhateverTheShapeOfTheMap) {
  const PictureFolder folder;
  for (const Eigen::Vector3f& far :
       {Eigen::Vector3f(500.0F, 0.0F, 0.0F), Eigen::Vector3f(0.0F, 500.0F, 0.0F),
        Eigen::Vector3f(300.0F, 300.0F, 40.0F)}) {
    MapPicture map;
    for (int i = 0; i <= 1000; ++i) map.points.push_back(far * (static_cast<float>(i) / 1000.0F));
    ASSERT_TRUE(write_map_picture(folder / "a.png", MapView::kAbove, map));
    EXPECT_LE(read_png(folder / "a.png").height, 1200);
  }
}

TEST(MapHeights, LeaveOutStrayPoints) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(0.0F, 0.0F, 0.002F * i);
  points.emplace_back(0.0F, 0.0F, 500.0F);
  points.emplace_back(0.0F, 0.0F, std::nanf(""));
  const HeightRange range = map_heights(points);
  EXPECT_NEAR(range.min, 0.02, 0.01);
  EXPECT_NEAR(range.max, 1.98, 0.01);
}

TEST(MapPicture, NamesThePathThatCannotBeWritten) {
  const PictureFolder folder;
  const auto written = write_map_picture(folder / "missing/a.png", MapView::kSide, {});
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("missing/a.png"), std::string::npos);
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A wall of points so dense that every cell of a picture holds one.
std::vector<Eigen::Vector3f> dense_wall(float length, float height, float spacing) {
  std::vector<Eigen::Vector3f> points;
  for (float x = 0.0F; x < length; x += spacing) {
    for (float z = 0.0F; z < height; z += spacing) points.emplace_back(x, 0.0F, z);
  }
  return points;
}

int images_in(const std::string& svg) {
  int images = 0;
  for (auto at = svg.find("<image"); at != std::string::npos; at = svg.find("<image", at + 1)) {
    ++images;
  }
  return images;
}

TEST(MapPicture, DrawsFewPointsAsShapesInAVectorPicture) {
  const PictureFolder folder;
  MapPicture map;
  map.points = dense_wall(4.0F, 0.2F, 0.01F);
  ASSERT_TRUE(write_map_picture(folder / "a.svg", MapView::kSide, map));
  const std::string svg = text_of(folder / "a.svg");
  EXPECT_EQ(images_in(svg), 1) << "the colour bar";
  const auto closings =
      std::count(svg.begin(), svg.end(), 'Z') + std::count(svg.begin(), svg.end(), 'z');
  EXPECT_GT(closings, 1000) << "a square is a closed path";
}

TEST(MapPicture, DrawsManyPointsAsFewerLargerShapesInAVectorPicture) {
  const PictureFolder folder;
  MapPicture map;
  map.points = dense_wall(40.0F, 10.0F, 0.02F);
  ASSERT_TRUE(write_map_picture(folder / "a.svg", MapView::kSide, map));
  const std::string svg = text_of(folder / "a.svg");
  EXPECT_EQ(images_in(svg), 1) << "the colour bar";
  EXPECT_LT(svg.size(), 8'000'000U);
}

}  // namespace
}  // namespace aims
