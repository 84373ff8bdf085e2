// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/fidelity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace aims {
namespace {

/// A walk of 8 m with textbook sensors: everything that the study measures is known.
Scenario short_scenario() {
  Scenario scenario;
  scenario.sensors = SensorLevel::kIdeal;
  SimulationConfig& config = scenario.simulation;
  config.scene.corridor.length = 8.0;
  config.route.points = {{"a", 0.0, 0.0}, {"b", 8.0, 0.0}};
  config.lidar.columns = 256;
  config.imu.gyro.noise_density = 0.001;
  config.leg_odometry.velocity_scale = 0.8;
  config.leg_odometry.velocity_scale_error = 0.0;
  config.leg_odometry.slip_rate = 0.0;
  return scenario;
}

TEST(Fidelity, FindsTheConfiguredErrors) {
  const auto fidelity = fidelity_study(short_scenario(), short_scenario(), 3, 20.0,
                                       [](std::string_view) { return true; });
  ASSERT_TRUE(fidelity) << fidelity.error().message;
  for (const ResidualBin& each : fidelity->ranges) {
    if (each.returns < 1000 || each.incidence_end_deg > 75.0) continue;
    EXPECT_NEAR(each.std, 0.02, 0.002) << each.range_begin << " m";
    EXPECT_NEAR(each.mean, 0.0, 0.003);
  }
  for (const StandingDeviation& each : fidelity->allan) {
    if (each.tau != 0.1) continue;
    EXPECT_NEAR(each.gyro, 0.001 / std::sqrt(0.1), 0.0005) << "white noise: N / sqrt(tau)";
  }
  ASSERT_FALSE(fidelity->stance.empty());
  for (const StanceBin& each : fidelity->stance) {
    if (each.event != StanceEvent::kTouchdown || each.time < 0.08) continue;
    EXPECT_NEAR(each.simulated.slip, 0.0, 0.1) << "stiff legs: a loaded foot does not slip";
  }
  ASSERT_EQ(fidelity->legs.size(), 4U) << "two foot models, two thresholds, one segment";
  for (const LegDrift& each : fidelity->legs) {
    EXPECT_LT(each.signed_percent, -15.0) << "20 % short by the injected scale";
    EXPECT_GT(each.signed_percent, -40.0);
  }
}

std::array<std::size_t, 3> bins_within(const std::vector<std::string>& overrides) {
  const std::filesystem::path folder = AIMS_SCENARIOS;
  const auto scenario =
      load_scenario(folder / "fidelity" / "fidelity_go1_walk.yaml", overrides, folder);
  if (!scenario) throw std::runtime_error(scenario.error().message);
  const auto profile = stance_study(*scenario, 601, [](std::string_view) { return true; });
  if (!profile) throw std::runtime_error(profile.error().message);
  const auto agreement = stance_agreement(*profile);
  return {agreement[0].within, agreement[1].within, agreement[2].within};
}

/// Of 35 bins; seed 601 was looked at only after everything was chosen.
TEST(Fidelity, TheWalkOfAGo1HasItsStance) {
  const auto within = bins_within({});
  EXPECT_GE(within[0], 27U) << "slip";
  EXPECT_GE(within[1], 24U) << "height";
  EXPECT_GE(within[2], 30U) << "load";
  EXPECT_LT(bins_within({"robot.gait.trunk.vault=0"})[2], within[2]) << "the vault shapes the load";
  EXPECT_LT(bins_within({"robot.gait.swing.shape=minimum_jerk"})[1], within[1])
      << "the path of the foot shapes its height";
}

TEST(Fidelity, StopsWhenTheObserverReturnsFalse) {
  int calls = 0;
  const auto fidelity = fidelity_study(short_scenario(), short_scenario(), 3, 20.0,
                                       [&](std::string_view) { return ++calls < 3; });
  EXPECT_FALSE(fidelity);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace aims
