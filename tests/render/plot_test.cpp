// SPDX-License-Identifier: BSD-3-Clause
#include "render/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "render/scene_plan.hpp"
#include "render/time_plot.hpp"
#include "render/trajectory_plot.hpp"
#include "tests/render/picture_file.hpp"

namespace aims {
namespace {

using test::count_pixels;
using test::kBlue;
using test::PictureFolder;
using test::read_png;

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> result;
  for (const Tick& tick : ticks) result.push_back(tick.label);
  return result;
}

TEST(Ticks, StandAtRoundNumbers) {
  EXPECT_EQ(labels(linear_ticks(-2.3, 83.1, 10)),
            (std::vector<std::string>{"0", "10", "20", "30", "40", "50", "60", "70", "80"}));
  EXPECT_EQ(labels(linear_ticks(-0.11, 0.12, 6)),
            (std::vector<std::string>{"\u22120.10", "\u22120.05", "0.00", "0.05", "0.10"}));
}

TEST(Ticks, StayInsideTheIntervalAndBelowTheCount) {
  for (const double min : {-1234.5, -0.003, 0.0, 7.0, 1e6}) {
    for (const double span : {1e-3, 0.7, 3.0, 99.0, 12345.0}) {
      for (const int count : {2, 5, 12}) {
        const auto ticks = linear_ticks(min, min + span, count);
        EXPECT_LE(ticks.size(), static_cast<std::size_t>(count));
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
  EXPECT_TRUE(logarithmic_ticks(0.0, 1.0).empty());
  EXPECT_TRUE(logarithmic_ticks(-1.0, 1.0).empty());
}

TEST(Ticks, OfALogarithmicAxisStandAtPowersOfTen) {
  EXPECT_EQ(labels(logarithmic_ticks(0.01, 20.0)),
            (std::vector<std::string>{"0.01", "0.1", "1", "10"}));
  EXPECT_EQ(labels(logarithmic_ticks(1.5, 60.0)),
            (std::vector<std::string>{"2", "5", "10", "20", "50"}));
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
  EXPECT_NEAR(count_pixels(image, kBlue), 3 * 100, 110);
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

/// Straight way of 20 m in 20 s, `drift` [m] aside at its end.
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
  plot.passages = {{"a", 0}, {"b", 20 * kSecond}};
  plot.estimates = {{"near", straight(0.3)}};
  ASSERT_TRUE(write_trajectory_plot(folder / "near.png", plot));
  plot.estimates.push_back({"far", straight(1e7)});
  plot.estimates.back().trajectory[150].pose.translation.z() = std::nan("");
  plot.estimates.push_back({"silent", {}});
  ASSERT_TRUE(write_trajectory_plot(folder / "far.png", plot));
  const int near = count_pixels(read_png(folder / "near.png"), kBlue);
  const int far = count_pixels(read_png(folder / "far.png"), kBlue);
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
  EXPECT_GT(count_pixels(read_png(folder / "a.png"), kBlue), 1000);
}

}  // namespace
}  // namespace aims
