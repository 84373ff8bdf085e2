// SPDX-License-Identifier: BSD-3-Clause
// What scans of a simulated walk say about the scale of the legs (`aims calibrate`).
#include <gtest/gtest.h>

#include <algorithm>

#include "estimator/aims/eskf_estimator.hpp"
#include "estimator/aims/presets.hpp"
#include "tests/estimator/simulated_sequence.hpp"

namespace aims {
namespace {

/// Information about the leg scale along the way, after 26 m between plain walls or past doors.
double scale_information(bool doors) {
  SimulationConfig config = testing::straight_sequence(26.0, 64);
  config.scene.corridor.end_walls = EndWalls::kNone;
  config.scene.corridor.doors.spacing = 3.0;
  if (!doors) config.scene.corridor.doors.sides = WallSides::kNone;
  config.scene.corridor.margin = 15.0;
  config.lidar.range_max = 10.0;
  const testing::SimulatedSequence sequence = testing::simulate(config, 1);
  EskfConfig measuring = eskf_preset("aims_d");
  measuring.feet.enabled = false;
  measuring.cross_validation.measure_legs = true;
  EskfEstimator estimator(measuring, sequence.rig);
  for (const Delivery& delivery : sequence.deliveries) estimator.consume(delivery);
  estimator.finish();
  const auto learned = estimator.learned();
  return std::ranges::find(learned, "legs_as_reported", &LearnedQuantity::name)->information(0, 0);
}

TEST(LegComparisonSimulation, PlainWallsSayNothingAboutTheScale) {
  EXPECT_EQ(scale_information(false), 0.0);
  EXPECT_GT(scale_information(true), 0.0);
}

}  // namespace
}  // namespace aims
