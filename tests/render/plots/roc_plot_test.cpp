// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/roc_plot.hpp"

#include <gtest/gtest.h>

#include "tests/render/plots/picture_file.hpp"

namespace aims {
namespace {

using test::colour_of;
using test::count_pixels;
using test::PictureFolder;
using test::read_png;

RocPlot one_detector(std::vector<Eigen::Vector2d> points) {
  return {"title", "subtitle", {{"first", {{"D (1.00)", std::move(points)}}}, {"second", {}}}};
}

TEST(RocPlot, DrawsACurveWhereItsPointsAre) {
  const PictureFolder folder;
  const auto path = folder / "roc.png";
  ASSERT_TRUE(write_roc_plot(path, one_detector({{0, 0}, {0, 1}, {1, 1}})));
  const Image perfect = read_png(path);
  ASSERT_TRUE(write_roc_plot(path, one_detector({{0, 0}, {1, 1}})));
  const Image chance = read_png(path);
  EXPECT_EQ(perfect.width, chance.width);
  EXPECT_GT(count_pixels(perfect, colour_of(0)), count_pixels(chance, colour_of(0)));
  EXPECT_GT(count_pixels(chance, colour_of(0)), 300);
}

TEST(RocPlot, WithoutAnythingToDetectIsStillAPicture) {
  const PictureFolder folder;
  ASSERT_TRUE(write_roc_plot(folder / "roc.png", {"title", "", {{"only", {}}}}));
  EXPECT_EQ(count_pixels(read_png(folder / "roc.png"), colour_of(0)), 0);
  ASSERT_TRUE(write_roc_plot(folder / "roc.svg", one_detector({{0, 0}, {1, 1}})));
  EXPECT_EQ(folder.files(), 2U);
}

TEST(RocPlot, ThatCannotBeWrittenIsAnError) {
  EXPECT_FALSE(write_roc_plot("/nowhere/roc.png", one_detector({{0, 0}, {1, 1}})));
}

}  // namespace
}  // namespace aims
