// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/field_plot.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "render/plots/palette.hpp"
#include "tests/render/plots/picture_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

FieldPlot plot_of(std::vector<FieldCell> cells) {
  FieldPlot plot;
  plot.title = "error";
  plot.x_label = "eta [-]";
  plot.y_label = "kappa [-]";
  plot.value_label = "ATE [m]";
  plot.logarithmic_y = true;
  plot.panels = {{"corridor", std::move(cells)}};
  return plot;
}

int pixels_of(const Image& image, double fraction) {
  const Color color = height_color(fraction);
  const auto byte = [](double part) { return static_cast<int>(255.0 * part + 0.5); };
  return test::count_pixels(image, {byte(color.red), byte(color.green), byte(color.blue)}, 3);
}

TEST(FieldPlot, CellsHaveTheColoursOfTheirValuesAndEqualShares) {
  const test::PictureFolder folder;
  // y = 1, 10, 100 are evenly spaced on a logarithmic axis: nine cells of 133 pixels squared
  std::vector<FieldCell> cells;
  for (const double x : {0.0, 1.0, 2.0}) {
    for (const double y : {1.0, 10.0, 100.0}) cells.push_back({x, y, 1.0});
  }
  cells[0].value = 0.0;
  cells[4].value = 2.0;
  ASSERT_TRUE(write_field_plot(folder / "field.png", plot_of(cells)));
  const Image image = test::read_png(folder / "field.png");
  constexpr double kCell = 400.0 * 400.0 / 9.0;
  constexpr double kLines = 0.08;  // fraction of a cell under the grid and the frame
  EXPECT_NEAR(pixels_of(image, 0.0), kCell, kLines * kCell);
  EXPECT_NEAR(pixels_of(image, 1.0), kCell, kLines * kCell);
  EXPECT_NEAR(pixels_of(image, 0.5), 7.0 * kCell, kLines * 7.0 * kCell);
}

TEST(FieldPlot, LongSubtitlesAreNotCut) {
  const test::PictureFolder folder;
  FieldPlot plot = plot_of({{0, 1, 1.0}, {1, 1, 2.0}, {0, 10, 1.5}, {1, 10, 1.2}});
  plot.subtitle =
      "mean of m_list_percent.all over that of the defaults, a diverged run counts 10; by a "
      "polynomial "
      "through the points";
  ASSERT_TRUE(write_field_plot(folder / "field.png", plot));
  const Image image = test::read_png(folder / "field.png");
  EXPECT_EQ(test::ink_right_of(image, image.width - 10), 0);
}

TEST(FieldPlot, TakesGapsAndNothing) {
  const TemporaryFolder folder;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(write_field_plot(folder.path() / "gaps.png",
                               plot_of({{0, 1, 1.0}, {1, 1, {}}, {0, 10, nan}, {1, 10, 2.0}})));
  EXPECT_TRUE(write_field_plot(folder.path() / "one.png", plot_of({{0, 1, 1.0}})));
  EXPECT_TRUE(write_field_plot(folder.path() / "empty.png", plot_of({})));
  EXPECT_FALSE(write_field_plot(folder.path() / "nowhere" / "x.png", plot_of({})));
}

}  // namespace
}  // namespace aims
