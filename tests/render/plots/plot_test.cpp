// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "render/plots/scene_plan.hpp"
#include "render/plots/thinned_line.hpp"
#include "render/plots/time_plot.hpp"
#include "render/plots/trajectory_plot.hpp"
#include "tests/render/plots/picture_file.hpp"

namespace aims {
namespace {

using test::colour_of;
using test::count_pixels;
using test::PictureFolder;
using test::read_png;

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> result;
  for (const Tick& tick : ticks) result.push_back(tick.label);
  return result;
}

TEST(Ticks, StandWhereThoseOfPagesDo) {
  std::ifstream file(AIMS_TICKS);
  std::string line;
  int cases = 0;
  while (std::getline(file, line)) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string kind;
    double min = 0.0, max = 0.0;
    int most = 0;
    words >> kind >> min >> max >> most;
    const auto ticks =
        kind == "log" ? logarithmic_ticks(min, max, most) : linear_ticks(min, max, most);
    std::size_t i = 0;
    for (double value = 0.0; words >> value; ++i) {
      ASSERT_LT(i, ticks.size()) << line;
      const double scale = kind == "log" ? value : max - min;
      EXPECT_NEAR(ticks[i].value, value, 1e-6 * scale) << line;
    }
    EXPECT_EQ(i, ticks.size()) << line;
    ++cases;
  }
  EXPECT_GE(cases, 16);
}

TEST(Ticks, HaveLabelsOfTheSameDecimals) {
  EXPECT_EQ(labels(linear_ticks(-2.3, 83.1, 9)),
            (std::vector<std::string>{"0", "10", "20", "30", "40", "50", "60", "70", "80"}));
  EXPECT_EQ(labels(linear_ticks(-0.11, 0.12, 5)),
            (std::vector<std::string>{"\u22120.10", "\u22120.05", "0.00", "0.05", "0.10"}));
}

TEST(Ticks, StayInsideTheIntervalAndNearTheCount) {
  for (const double min : {-1234.5, -0.003, 0.0, 7.0, 1e6}) {
    for (const double span : {1e-3, 0.7, 3.0, 99.0, 12345.0}) {
      for (const int most : {2, 5, 12}) {
        const auto ticks = linear_ticks(min, min + span, most);
        EXPECT_LE(static_cast<double>(ticks.size()), most / 0.8 + 1.0);
        for (const Tick& tick : ticks) {
          EXPECT_GE(tick.value, min - 1e-6 * span);
          EXPECT_LE(tick.value, min + span * (1.0 + 1e-6));
        }
      }
    }
  }
}

TEST(Ticks, AreAbsentFromAnIntervalThatIsNone) {
  const double nan = std::nan("");
  EXPECT_TRUE(linear_ticks(1.0, 1.0, 5).empty());
  EXPECT_TRUE(linear_ticks(2.0, 1.0, 5).empty());
  EXPECT_TRUE(linear_ticks(nan, 1.0, 5).empty());
  EXPECT_TRUE(linear_ticks(0.0, INFINITY, 5).empty());
  EXPECT_TRUE(logarithmic_ticks(0.0, 1.0, 5).empty());
  EXPECT_TRUE(logarithmic_ticks(-1.0, 1.0, 5).empty());
}

TEST(Ticks, OfManyDecadesAreFewAndShort) {
  EXPECT_EQ(labels(logarithmic_ticks(1e-10, 100.0, 7)),
            (std::vector<std::string>{"1e\u221210", "1e\u22128", "1e\u22126", "0.0001", "0.01", "1",
                                      "100"}));
}

TEST(Ticks, OfALogarithmicAxisOfLessThanADecadeAreSeveral) {
  EXPECT_EQ(labels(logarithmic_ticks(0.9, 1.32, 5)),
            (std::vector<std::string>{"0.9", "1.0", "1.1", "1.2", "1.3"}));
  for (const double min : {0.011, 0.3, 1.9, 2.1, 7.0, 640.0}) {
    for (const double factor : {1.02, 1.2, 1.44, 2.0, 4.0, 9.0, 40.0}) {
      const auto ticks = logarithmic_ticks(min, factor * min, 5);
      EXPECT_GE(ticks.size(), 2U) << min << " " << factor;
      for (const Tick& tick : ticks) {
        EXPECT_GE(tick.value, min * (1.0 - 1e-6));
        EXPECT_LE(tick.value, factor * min * (1.0 + 1e-6));
      }
    }
  }
}

TEST(Wrapped, LinesFitAndHaveAllWordsInOrder) {
  const TextStyle style{.size = 13.0};
  const std::string text =
      "mean of ate_m over that of the defaults, a diverged run counts 10; measured";
  Canvas ruler = Canvas::over(Image(1, 1));
  for (const double width : {90.0, 200.0, 300.0, 2000.0}) {
    std::string joined;
    for (const std::string& line : wrapped(text, width, style)) {
      EXPECT_LE(ruler.text_width(line, style), width) << line;
      joined += (joined.empty() ? "" : " ") + line;
    }
    EXPECT_EQ(joined, text);
  }
  EXPECT_EQ(wrapped("a verylongword b", 20.0, style),
            (std::vector<std::string>{"a", "verylongword", "b"}));
  EXPECT_EQ(wrapped("first  \u00b7  second", 40.0, style),
            (std::vector<std::string>{"first", "second"}));
  EXPECT_TRUE(wrapped("", 100.0, style).empty());
}

TEST(Plot, LongSubtitlesTakeMoreLinesAndAreNotCut) {
  const PictureFolder folder;
  const auto drawn = [&](const std::string& subtitle) {
    Panel panel;
    panel.x = {"x [m]", 0.0, 1.0};
    panel.y = {"y [m]", 0.0, 1.0};
    panel.height = 100.0;
    Figure figure{.title = "title", .subtitle = subtitle, .panels = {panel}, .width = 400};
    EXPECT_TRUE(write_figure(folder / "a.png", figure));
    return read_png(folder / "a.png");
  };
  std::string text = "word";
  const int height = drawn(text).height;
  for (int i = 0; i < 30; ++i) text += " word";
  const Image image = drawn(text);
  EXPECT_GT(image.height, height + 30);
  EXPECT_EQ(test::ink_right_of(image, image.width - 10), 0);
}

TEST(Plot, PutsDataPointsWhereTheAxesSay) {
  Panel panel;
  panel.x = {"x [m]", 10.0, 20.0};
  panel.y = {"y [m]", 0.1, 1000.0, true};
  const Rect area{100.0, 50.0, 200.0, 80.0};
  EXPECT_TRUE(to_pixels(panel, area, {10.0, 0.1}).isApprox(Eigen::Vector2d(100.0, 130.0)));
  EXPECT_TRUE(to_pixels(panel, area, {20.0, 1000.0}).isApprox(Eigen::Vector2d(300.0, 50.0)));
  EXPECT_TRUE(to_pixels(panel, area, {15.0, 10.0}).isApprox(Eigen::Vector2d(200.0, 90.0)));
  EXPECT_TRUE(to_pixels(panel, area, {15.0, -1.0}).allFinite());
}

TEST(Plot, CutsALineThatLeavesItsAxes) {
  const PictureFolder folder;
  Panel panel;
  panel.x = {"x [m]", 0.0, 1.0};
  panel.y = {"y [m]", 0.0, 1.0};
  panel.height = 100.0;
  panel.series = {{"", {{0.5, -1e9}, {0.5, 1e9}}, {series_color(0), 3.0}}};
  Figure figure{.title = "", .panels = {panel}, .width = 400};
  ASSERT_TRUE(write_figure(folder / "a.png", figure));
  const Image image = read_png(folder / "a.png");
  EXPECT_NEAR(count_pixels(image, colour_of(0)), 3 * 100, 110);
}

TEST(Plot, ThinsALineToWhatItsPixelsShow) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 1'000'000; ++i) {
    points.emplace_back(700e-6 * i, 100.0 + 50.0 * std::sin(0.37 * i) + 30.0 * std::sin(1e-5 * i));
  }
  points[500'000].y() = std::nan("");
  points[250'000].y() = 190.0;  // a spike of one point
  const auto thin = thinned_line(points);
  EXPECT_LT(thin.size(), 4 * 4 * 701U);
  EXPECT_EQ(thin.front(), points.front());
  EXPECT_EQ(thin.back(), points.back());
  // Oracle: the lowest and the highest value over each pixel.
  const auto range_of = [](const std::vector<Eigen::Vector2d>& line) {
    std::vector<std::pair<double, double>> ranges(700, {1e9, -1e9});
    int gaps = 0;
    for (const Eigen::Vector2d& each : line) {
      gaps += each.allFinite() ? 0 : 1;
      if (!each.allFinite()) continue;
      auto& [low, high] = ranges[static_cast<std::size_t>(each.x())];
      low = std::min(low, each.y());
      high = std::max(high, each.y());
    }
    EXPECT_EQ(gaps, 1);
    return ranges;
  };
  EXPECT_EQ(range_of(thin), range_of(points));
  points.resize(1'000);
  EXPECT_EQ(thinned_line(points), points);
}

TEST(ScenePlan, SeesThroughLintelsAndRoofs) {
  Solid wall;
  wall.half_extents = {2.0, 0.1, 1.3};
  wall.T_world_solid.translation = {1.0, 1.0, 1.3};
  Solid lintel = wall;
  lintel.half_extents.z() = 0.2;
  lintel.T_world_solid.translation.z() = 2.4;
  Solid roof = wall;
  roof.roof = true;
  const auto plan = scene_plan(Scene{{}, {wall, lintel, roof}, {}});
  ASSERT_EQ(plan.size(), 1U);
  EXPECT_EQ(plan[0].size(), 4U);
  double area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d& a = plan[0][i];
    const Eigen::Vector2d& b = plan[0][(i + 1) % 4];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_NEAR(area, 4.0 * 0.2, 1e-9);
}

/// Straight path of 20 m in 20 s, `drift` [m] aside at its end.
Trajectory straight(double drift) {
  Trajectory trajectory;
  for (int i = 0; i <= 200; ++i) {
    StampedPose sample;
    sample.stamp = i * 100 * kMillisecond;
    sample.pose.translation = {0.1 * i, drift * i / 200.0, 0.3};
    trajectory.push_back(sample);
  }
  return trajectory;
}

TEST(TrajectoryPlot, DrawsTheTruthWhereItIsWhateverDiverges) {
  const PictureFolder folder;
  TrajectoryPlot plot;
  plot.truth = straight(0.0);
  plot.waypoint_times = {{"a", 0}, {"b", 20 * kSecond}};
  plot.estimates = {{"near", straight(0.3)}};
  ASSERT_TRUE(write_trajectory_plot(folder / "near.png", plot));
  plot.estimates.push_back({"far", straight(1e7)});
  plot.estimates.back().trajectory[150].pose.translation.z() = std::nan("");
  plot.estimates.push_back({"silent", {}});
  ASSERT_TRUE(write_trajectory_plot(folder / "far.png", plot));
  const int near = count_pixels(read_png(folder / "near.png"), colour_of("near"));
  const int far = count_pixels(read_png(folder / "far.png"), colour_of("near"));
  EXPECT_GT(near, 1000);
  EXPECT_GT(far, near / 2) << "the axes no longer show the good estimate";
}

TEST(TrajectoryPlot, NeedsATruth) {
  const PictureFolder folder;
  const auto written = write_trajectory_plot(folder / "a.png", {});
  ASSERT_FALSE(written);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(TimePlot, ShowsFiniteValuesAmongOthers) {
  const PictureFolder folder;
  TimePlot plot;
  TimeSeries series{"D_k", {}};
  for (int i = 0; i < 1000; ++i) series.points.emplace_back(0.1 * i, 1.0 + 0.5 * std::sin(0.1 * i));
  series.points[500].y() = std::nan("");
  series.points[501].y() = INFINITY;
  plot.panels = {{"Index", "D [-]", {series}, false, true},
                 {"Log", "D [-]", {series}, true},
                 {"Nothing", "[-]", {{"none", {}}}}};
  ASSERT_TRUE(write_time_plot(folder / "a.png", plot));
  EXPECT_GT(count_pixels(read_png(folder / "a.png"), colour_of(0)), 1000);
}

}  // namespace
}  // namespace aims
