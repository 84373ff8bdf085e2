// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/level_plot.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>

#include "tests/render/plots/picture_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

LevelPlot plot_of(const std::vector<LevelPoint>& points) {
  LevelPlot plot;
  plot.title = "loss";
  plot.level_label = "loss [%]";
  plot.panels = {{"ATE", "ATE [m]", {{"aims", points}}, true, false}};
  return plot;
}

/// As Cairo writes the stroke of series `index` into an SVG file.
std::string stroke_of(std::size_t index) {
  const std::array<int, 3> rgb = test::colour_of(index);
  const auto percent = [&](std::size_t i) { return fmt::format("{:.8g}%", rgb[i] / 2.55); };
  return fmt::format("stroke:rgb({},{},{})", percent(0), percent(1), percent(2));
}

TEST(LevelPlot, DrawsALineThroughTheValuesAndALinePerInterval) {
  const TemporaryFolder folder;
  const std::string colour = stroke_of(0);
  ASSERT_TRUE(write_level_plot(folder.path() / "plain.svg",
                               plot_of({{0.0, 0.1, {}, {}}, {10.0, 0.3, {}, {}}})));
  ASSERT_TRUE(write_level_plot(folder.path() / "intervals.svg",
                               plot_of({{0.0, 0.1, 0.05, 0.2}, {10.0, 0.3, 0.2, 0.4}})));
  const std::size_t plain = count(text_of(folder.path() / "plain.svg"), colour);
  EXPECT_EQ(plain, 2U) << "the curve and its legend";
  EXPECT_EQ(count(text_of(folder.path() / "intervals.svg"), colour), plain + 2);
}

TEST(LevelPlot, TakesMissingValuesAndEmptyFamilies) {
  const TemporaryFolder folder;
  EXPECT_TRUE(
      write_level_plot(folder.path() / "gap.png",
                       plot_of({{0.0, 0.1, {}, {}}, {1.0, {}, {}, {}}, {2.0, 0.0, {}, {}}})));
  EXPECT_TRUE(write_level_plot(folder.path() / "empty.png", plot_of({})));
  EXPECT_FALSE(write_level_plot(folder.path() / "nowhere" / "x.png", plot_of({})));
}

}  // namespace
}  // namespace aims
