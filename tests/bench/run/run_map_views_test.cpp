// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/run_map_views.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "sim/simulation.hpp"
#include "tests/bench/short_walk.hpp"

namespace aims {
namespace {

/// Six metres through a corridor.
struct WalkedCorridor {
  SimulationConfig config;
  SensorRig rig;
  Truth truth;
};

WalkedCorridor simulated(double range_max) {
  WalkedCorridor run;
  run.config = testing::short_walk().simulation;
  run.config.route.points = {{"a", 0.0, 0.0}, {"b", 6.0, 0.0}};
  run.config.lidar.range_max = range_max;
  auto simulation = Simulation::create(run.config, 2).value();
  std::vector<Delivery> deliveries;
  while (simulation.advance(kSecond, deliveries)) continue;
  run.rig = simulation.rig();
  run.truth = simulation.truth();
  return run;
}

const WalkedCorridor& run() {
  static const WalkedCorridor made = simulated(100.0);
  return made;
}

TEST(MapViews, DivideTheInformationOfEachScan) {
  const MapViews views = map_views(run().config, run().rig, 2, run().truth);
  ASSERT_EQ(views.scans.size(), run().truth.scans.size());
  for (std::size_t i = 0; i < views.scans.size(); ++i) {
    Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
    for (const PartInformation& each : views.scans[i].parts) {
      ASSERT_LT(static_cast<std::size_t>(each.part), views.centres.size());
      const double smallest = each.information.selfadjointView<Eigen::Lower>().eigenvalues()[0];
      EXPECT_GE(smallest, -1e-6 * each.information.norm());
      sum += each.information;
    }
    const auto& expected = run().truth.scans[i].information;
    EXPECT_LT((sum - expected).norm(), 1e-6 * expected.norm());
  }
}

TEST(MapViews, GiveNothingToPartsOutOfRange) {
  const WalkedCorridor near = simulated(2.0);
  const MapViews views = map_views(near.config, near.rig, 2, near.truth);
  ASSERT_GE(views.centres.size(), 3U) << "six metres in parts of two";
  const int last = static_cast<int>(views.centres.size()) - 1;
  const auto has = [](const ScanView& view, int part) {
    return std::ranges::find(view.parts, part, &PartInformation::part) != view.parts.end();
  };
  EXPECT_TRUE(has(views.scans.front(), 0));
  EXPECT_FALSE(has(views.scans.front(), last));
  EXPECT_TRUE(has(views.scans.back(), last));
  EXPECT_FALSE(has(views.scans.back(), 0));
}

TEST(MapViews, HaveAsManyPartsAsAllowed) {
  EXPECT_EQ(map_views(run().config, run().rig, 2, run().truth, 1.0, 3).centres.size(), 3U);
  EXPECT_EQ(map_views(run().config, run().rig, 2, run().truth, 100.0).centres.size(), 1U);
}

}  // namespace
}  // namespace aims
