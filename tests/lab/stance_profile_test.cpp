// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/stance_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aims {
namespace {

constexpr double kStep = 1.0 / kStanceProfileRate;  ///< [s]
constexpr double kStride = 0.5;                     ///< [s]
constexpr double kStance = 0.3;                     ///< [s]
constexpr double kRamp = 50.0;                      ///< of the slip about either edge [m/s^2]

/// Slip, height and load of a foot at a time since touchdown, periodic over the stride: the slip
/// passes 0.5 m/s on a ramp at both edges, the load is late.
FootReading foot_at(double t) {
  const double phase = std::fmod(t + 10.0 * kStride, kStride);
  const double to_edge = std::min({phase, kStance - phase});
  const double edge = phase > kStance ? std::min(phase - kStance, kStride - phase) : -to_edge;
  const double slip = std::clamp(0.5 + kRamp * edge, 0.0, 2.0);
  const bool loaded = phase > 0.02 && phase < kStance + 0.035;
  return {slip, 0.3 + 0.01 * std::sin(2.0 * std::numbers::pi * phase / kStride),
          loaded ? 70.0 : 10.0};
}

TEST(StanceProfile, IsThatOfEachStance) {
  std::vector<FeetReadings> readings;
  for (int i = 0; i < 2000; ++i) {
    FeetReadings feet;
    for (int leg = 0; leg < kLegCount; ++leg) feet[leg] = foot_at(i * kStep - 0.05 - 0.11 * leg);
    readings.push_back(feet);
  }
  const auto profile = stance_profile(readings);
  ASSERT_TRUE(profile);
  const double middle = foot_at(0.5 * kStance).height;
  for (const StanceBin& bin : *profile) {
    const double since = bin.event == StanceEvent::kTouchdown ? 0.0 : kStance;
    const FootReading expected = foot_at(since + bin.time);
    // A step may fall between two readings; ramps and the sine are far slower than them.
    EXPECT_NEAR(bin.simulated.slip, expected.slip, 0.07) << bin.time;
    EXPECT_NEAR(bin.simulated.height, expected.height - middle, 1e-3) << bin.time;
    const double load_before = foot_at(since + bin.time - kStep).load;
    const double load_after = foot_at(since + bin.time + kStep).load;
    if (load_before != load_after) continue;
    EXPECT_NEAR(bin.simulated.load, (expected.load - 10.0) / 60.0, 1e-9) << bin.time;
  }
}

TEST(StanceProfile, NeedsAWholeStance) {
  EXPECT_FALSE(stance_profile({}));
  EXPECT_FALSE(stance_profile(std::vector<FeetReadings>(400)));
}

/// A trunk that moves over feet which roll on the ground: no foot slips, whatever its angles.
TEST(StanceProfile, ARollingFootDoesNotSlip) {
  const LegGeometry geometry = {.hip_x = 0.19,
                                .hip_y = 0.05,
                                .abduction = 0.08,
                                .thigh = 0.213,
                                .calf = 0.213,
                                .foot_radius = 0.022};
  Truth truth;
  truth.mounts.T_base_body.translation = {-0.2, 0.0, 0.05};
  std::vector<LegOdometrySample> legs;
  const Eigen::Vector3d rate(0.0, 2.0, -1.0);
  for (int i = 0; i < 5; ++i) {
    LegOdometrySample sample;
    sample.stamp = from_seconds(i * kStep);
    for (int leg = 0; leg < kLegCount; ++leg) {
      for (int joint = 0; joint < 3; ++joint) {
        const double start[] = {0.0, 0.8, -1.6};
        sample.joint_position[3 * leg + joint] = start[joint] + rate[joint] * i * kStep;
      }
    }
    sample.contact_force = FootLoads{1.0, 2.0, 3.0, 4.0};
    legs.push_back(sample);
  }
  for (const LegOdometrySample& sample : legs) {
    const JointVector q = Eigen::Map<const JointVector>(sample.joint_position.data());
    TruthSample motion;
    motion.stamp = sample.stamp;
    motion.T_world_body = truth.mounts.T_base_body;
    motion.velocity = velocity_from_rolling_foot(0, {joints_of(q, 0), rate, {0.0, 0.0, 0.0}},
                                                 Eigen::Vector3d::UnitZ(), geometry);
    truth.samples.push_back(motion);
  }
  const auto readings = foot_readings(truth, legs, geometry);
  ASSERT_EQ(readings.size(), 3U);
  for (const FeetReadings& feet : readings) {
    EXPECT_NEAR(feet[0].slip, 0.0, 1e-6);
    EXPECT_NEAR(feet[2].slip, 0.0, 1e-6) << "the same angles on the same side";
    EXPECT_EQ(feet[3].load, 4.0);
    EXPECT_LT(feet[0].height, -0.25);
  }
  for (TruthSample& motion : truth.samples) motion.velocity.x() += 0.3;
  EXPECT_NEAR(foot_readings(truth, legs, geometry)[1][0].slip, 0.3, 1e-6);
}

TEST(StanceProfile, AgreesWithinAQuarterOrTheFloor) {
  StanceBin bin;
  bin.real = {2.0, 0.020, 1.0};
  bin.simulated = {2.4, 0.026, 1.24};
  const auto agreement = stance_agreement({bin});
  EXPECT_EQ(agreement[0].within, 1U);
  EXPECT_EQ(agreement[1].within, 0U);
  EXPECT_NEAR(agreement[1].worst, 6.0 / 5.0, 1e-9);
  EXPECT_EQ(agreement[2].within, 1U);
  bin.real = {0.0, 0.0, 0.0};
  bin.simulated = {0.09, 0.0019, 0.11};
  EXPECT_EQ(stance_agreement({bin})[0].within, 1U);
  EXPECT_EQ(stance_agreement({bin})[1].within, 1U);
  EXPECT_EQ(stance_agreement({bin})[2].within, 0U);
}

}  // namespace
}  // namespace aims
